#include "iga/topology/space.h"

#include <algorithm>
#include <cmath>

#include "iga/core/error.h"
#include "iga/spline/refine.h"

namespace couture::iga {

namespace {

/// Number of the breakpoint of `knots` at xi, or nothing.
std::optional<std::size_t> find_breakpoint(const KnotVector& knots, double xi) {
    const double slack = knot_tolerance_of_span * (knots.back() - knots.front());
    const std::vector<double>& breakpoints = knots.breakpoints();
    const auto found = std::lower_bound(breakpoints.begin(), breakpoints.end(), xi - slack);
    if (found == breakpoints.end() || *found > xi + slack) {
        return std::nullopt;
    }
    return found - breakpoints.begin();
}

void check_breakpoints(const KnotVector& geometry, const KnotVector& field, int patch,
                       int direction) {
    const double slack = knot_tolerance_of_span * (geometry.back() - geometry.front());
    if (std::abs(field.front() - geometry.front()) > slack ||
        std::abs(field.back() - geometry.back()) > slack) {
        throw InputError(
            "Space: patch {} direction {}: functions live on [{}, {}], the geometry on [{}, {}]; "
            "the intervals must be equal",
            patch, direction, field.front(), field.back(), geometry.front(), geometry.back());
    }
    for (const double breakpoint : geometry.breakpoints()) {
        if (!find_breakpoint(field, breakpoint)) {
            throw InputError(
                "Space: patch {} direction {}: the geometry's breakpoint {} is not among the "
                "functions'; add it as a knot",
                patch, direction, breakpoint);
        }
    }
}

/// Whether the functions of `fine` contain those of `coarse`; breakpoints are known to.
bool contains(const KnotVector& fine, const KnotVector& coarse) {
    if (fine.degree() < coarse.degree()) {
        return false;
    }
    for (std::size_t i = 1; i + 1 < coarse.breakpoints().size(); ++i) {
        const std::size_t j = *find_breakpoint(fine, coarse.breakpoints()[i]);
        if (fine.degree() - fine.multiplicities()[j] >
            coarse.degree() - coarse.multiplicities()[i]) {
            return false;
        }
    }
    return true;
}

template <int d>
bool contains(const TensorSpace<d>& fine, const TensorSpace<d>& coarse) {
    for (int k = 0; k < d; ++k) {
        if (!contains(fine.knots[k], coarse.knots[k])) {
            return false;
        }
    }
    return true;
}

/// Weights of the geometry as coefficients of `fine`.
template <int d>
VectorX prolongated_weights(const Patch<d>& patch, const TensorSpace<d>& fine) {
    if (fine == patch.space()) {
        return patch.weights();
    }
    std::array<SparseMatrix, d> matrices;
    for (int k = 0; k < d; ++k) {
        matrices[k] = prolongation_to(patch.knots(k), fine.knots[k]).prolongation;
    }
    return apply_kronecker<d>(matrices, patch.weights());
}

template <int d>
bool has_equal_weights(const Patch<d>& patch, int side) {
    const std::vector<int> functions =
        functions_on<d>(patch.space(), make_side<d>(0, side).position);
    const double first = patch.weights()[functions.front()];
    constexpr double rounding = 1e-14;
    return std::all_of(functions.begin(), functions.end(), [&](int i) {
        return std::abs(patch.weights()[i] - first) <= rounding * first;
    });
}

/// Which patches take rational functions: those that contain the geometry's. Where two patches meet
/// on a side with different weights both must, or the functions would not be continuous.
template <int d>
std::vector<bool> rational_patches(const MultiPatch<d>& geometry,
                                   const std::vector<TensorSpace<d>>& spaces) {
    std::vector<bool> is_rational;
    for (int p = 0; p < geometry.n_patches(); ++p) {
        const Patch<d>& patch = geometry.patches[p];
        is_rational.push_back(patch.is_rational() && contains(spaces[p], patch.space()));
    }
    bool changed = true;
    while (changed) {
        changed = false;
        for (const Interface<d>& interface : geometry.interfaces) {
            const bool first = is_rational[interface.first_patch];
            const bool second = is_rational[interface.second_patch];
            if (first == second) {
                continue;
            }
            const int patch = first ? interface.first_patch : interface.second_patch;
            const int side = first ? interface.first_side : interface.second_side;
            if (!has_equal_weights(geometry.patches[patch], side)) {
                is_rational[patch] = false;
                changed = true;
            }
        }
    }
    return is_rational;
}

template <int d>
std::vector<TensorSpace<d>> spaces_of(const MultiPatch<d>& geometry) {
    std::vector<TensorSpace<d>> spaces;
    for (const Patch<d>& patch : geometry.patches) {
        spaces.push_back(patch.space());
    }
    return spaces;
}

}  // namespace

template <int d>
Space<d>::Space(MultiPatch<d> geometry) : Space(geometry, spaces_of(geometry)) {}

template <int d>
Space<d>::Space(MultiPatch<d> geometry, std::vector<TensorSpace<d>> spaces)
    : geometry_(std::move(geometry)), spaces_(std::move(spaces)) {
    if (spaces_.size() != geometry_.patches.size()) {
        throw InputError("Space: {} tensor spaces for {} patches; each patch takes one",
                         spaces_.size(), geometry_.patches.size());
    }
    is_isoparametric_ = true;
    for (int p = 0; p < n_patches(); ++p) {
        const TensorSpace<d>& own = geometry_.patches[p].space();
        for (int k = 0; k < d; ++k) {
            check_breakpoints(own.knots[k], spaces_[p].knots[k], p, k);
        }
        is_isoparametric_ = is_isoparametric_ && own == spaces_[p];
    }
    dof_map_ = make_dof_map(geometry_, spaces_);
    const std::vector<bool> is_rational = rational_patches(geometry_, spaces_);
    for (int p = 0; p < n_patches(); ++p) {
        weights_.push_back(is_rational[p] ? prolongated_weights(geometry_.patches[p], spaces_[p])
                                          : VectorX());
    }
}

template <int d>
Space<d>::Space(MultiPatch<d> geometry, std::vector<TensorSpace<d>> spaces, DofMap dof_map)
    : geometry_(std::move(geometry)),
      spaces_(std::move(spaces)),
      dof_map_(std::move(dof_map)),
      is_isoparametric_(true) {
    for (int p = 0; p < n_patches(); ++p) {
        const bool is_own = spaces_[p] == geometry_.patches[p].space();
        weights_.push_back(is_own ? geometry_.patches[p].weights() : VectorX());
        is_isoparametric_ = is_isoparametric_ && is_own;
    }
}

template <int d>
std::vector<int> Space<d>::dofs_on(const PatchEntity<d>& entity) const {
    if (entity.patch < 0 || entity.patch >= n_patches()) {
        throw InputError("Space: patch {} does not exist; there are {}", entity.patch, n_patches());
    }
    std::vector<int> result = functions_on<d>(spaces_[entity.patch], entity.position);
    for (int& i : result) {
        i = dofs(entity.patch)[i];
    }
    std::sort(result.begin(), result.end());
    result.erase(std::unique(result.begin(), result.end()), result.end());
    return result;
}

template class Space<2>;
template class Space<3>;

}  // namespace couture::iga
