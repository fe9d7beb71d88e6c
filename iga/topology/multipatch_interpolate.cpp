#include "iga/topology/multipatch_interpolate.h"

#include <algorithm>
#include <limits>
#include <vector>

#include "iga/core/error.h"
#include "iga/core/parallel.h"
#include "iga/spline/approximate.h"
#include "iga/spline/refine.h"
#include "iga/topology/dof_map.h"
#include "iga/topology/interface_match.h"

namespace couture::iga {

namespace {

/// How often `knots` has a knot here.
int multiplicity(const KnotVector& knots, double knot) {
    return static_cast<int>(std::count(knots.knots().begin(), knots.knots().end(), knot));
}

/// Knots of the wanted degree on the elements of the refined geometry.
KnotVector interpolation_knots(const KnotVector& geometry, int degree, int n_elements) {
    const KnotVector refined = refine(geometry, geometry.degree(), n_elements).knots;
    std::vector<double> knots;
    for (const double breakpoint : refined.breakpoints()) {
        const bool is_end = breakpoint == refined.front() || breakpoint == refined.back();
        const int in_geometry = multiplicity(geometry, breakpoint);
        const int continuity = geometry.degree() - in_geometry;
        const int own = is_end             ? degree + 1
                        : in_geometry == 0 ? 1
                                           : std::max(1, degree - continuity);
        knots.insert(knots.end(), own, breakpoint);
    }
    return {degree, knots};
}

/// Splines in the wanted spaces that conform across interfaces; all their control points are 0.
template <int d>
MultiPatch<d> make_spaces(const MultiPatch<d>& multipatch, std::optional<int> degree,
                          std::optional<std::array<int, d>> n_elements) {
    MultiPatch<d> result = multipatch;
    for (Patch<d>& patch : result.patches) {
        TensorSpace<d> space = patch.space();
        for (int k = 0; k < d; ++k) {
            const KnotVector& own = patch.knots(k);
            space.knots[k] = interpolation_knots(own, degree.value_or(own.degree()),
                                                 n_elements ? (*n_elements)[k] : own.n_elements());
        }
        const MatrixX zeros = MatrixX::Zero(space.n_basis(), patch.dimension());
        patch = Patch<d>(space, zeros);
    }
    make_conforming(result, std::numeric_limits<double>::infinity());
    return result;
}

/// Gives shared control points the value of their first patch: the others' differ by rounding.
template <int d>
void join_control_points(MultiPatch<d>& multipatch) {
    std::vector<TensorSpace<d>> spaces;
    for (const Patch<d>& patch : multipatch.patches) {
        spaces.push_back(patch.space());
    }
    const DofMap dofs = make_dof_map(multipatch, spaces);
    MatrixX first(dofs.n_dofs, multipatch.dimension());
    std::vector<bool> is_set(dofs.n_dofs, false);
    for (int p = 0; p < multipatch.n_patches(); ++p) {
        MatrixX points = multipatch.patches[p].control_points();
        for (int i = 0; i < points.rows(); ++i) {
            const int dof = dofs.global[p][i];
            if (!is_set[dof]) {
                first.row(dof) = points.row(i);
                is_set[dof] = true;
            }
            points.row(i) = first.row(dof);
        }
        multipatch.patches[p] = Patch<d>(spaces[p], points);
    }
}

}  // namespace

template <int d>
MultiPatch<d> interpolate(const MultiPatch<d>& multipatch, std::optional<int> degree,
                          std::optional<std::array<int, d>> n_elements) {
    if (degree && (*degree < 1 || *degree > max_degree)) {
        throw InputError("interpolate: degree {} is out of range; it must lie in [1, {}]", *degree,
                         max_degree);
    }
    check_combinatorics(multipatch);
    MultiPatch<d> result = make_spaces<d>(multipatch, degree, n_elements);
    parallel_for(result.n_patches(), [&](int p) {
        const Patch<d>& original = multipatch.patches[p];
        const TensorSpace<d> space = result.patches[p].space();
        result.patches[p] = Patch<d>(
            space, interpolate<d>(space, original.dimension(), [&](const Vector<d>& xi) -> VectorX {
                return original.point(xi);
            }));
    });
    join_control_points(result);
    return result;
}

template MultiPatch<2> interpolate<2>(const MultiPatch<2>&, std::optional<int>,
                                      std::optional<std::array<int, 2>>);
template MultiPatch<3> interpolate<3>(const MultiPatch<3>&, std::optional<int>,
                                      std::optional<std::array<int, 3>>);

}  // namespace couture::iga
