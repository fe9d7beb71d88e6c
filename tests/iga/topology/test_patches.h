#pragma once

#include <array>
#include <vector>

#include "iga/topology/multipatch.h"

namespace couture::iga {

/// Patch whose control points are `map` of the Greville points: an affine map is reproduced.
template <int d, typename Map>
Patch<d> make_mapped_patch(const TensorSpace<d>& space, const Map& map) {
    std::array<std::vector<double>, d> greville;
    for (int k = 0; k < d; ++k) {
        greville[k] = space.knots[k].greville();
    }
    MatrixX points;
    for (int i = 0; i < space.n_basis(); ++i) {
        Vector<d> xi;
        for (int k = 0, rest = i; k < d; rest /= space.knots[k].n_basis(), ++k) {
            xi[k] = greville[k][rest % space.knots[k].n_basis()];
        }
        const VectorX x = map(xi);
        if (i == 0) {
            points.resize(space.n_basis(), x.size());
        }
        points.row(i) = x.transpose();
    }
    return {space, points};
}

/// A patch that runs through the same points along permuted and reversed directions: direction k of
/// the result is direction axis[k] of `patch`, read backwards if reversed[k].
template <int d>
Patch<d> reoriented(const Patch<d>& patch, const std::array<int, d>& axis,
                    const std::array<bool, d>& reversed) {
    std::vector<KnotVector> knots;
    for (int k = 0; k < d; ++k) {
        const KnotVector& own = patch.knots(axis[k]);
        knots.push_back(reversed[k] ? own.reversed() : own);
    }
    TensorSpace<d> space = [&] {
        if constexpr (d == 2) {
            return TensorSpace<2>{{knots[0], knots[1]}};
        } else {
            return TensorSpace<3>{{knots[0], knots[1], knots[2]}};
        }
    }();
    MatrixX points(space.n_basis(), patch.dimension());
    VectorX weights(patch.weights().size());
    for (int i = 0; i < space.n_basis(); ++i) {
        const auto here = space.indices(i);
        auto there = here;
        for (int k = 0; k < d; ++k) {
            there[axis[k]] = reversed[k] ? knots[k].n_basis() - 1 - here[k] : here[k];
        }
        const int j = patch.space().index(there);
        points.row(i) = patch.control_points().row(j);
        if (patch.is_rational()) {
            weights[i] = patch.weights()[j];
        }
    }
    return {space, points, weights};
}

/// [0, 1]^d of one degree with equal elements, moved by `offset`.
template <int d>
Patch<d> make_unit_box(int degree, int n_elements, const Vector<d>& offset = Vector<d>::Zero()) {
    const KnotVector knots = KnotVector::uniform(degree, n_elements);
    TensorSpace<d> space = [&] {
        if constexpr (d == 2) {
            return TensorSpace<2>{{knots, knots}};
        } else {
            return TensorSpace<3>{{knots, knots, knots}};
        }
    }();
    return make_mapped_patch<d>(space, [&](const Vector<d>& xi) { return VectorX(xi + offset); });
}

}  // namespace couture::iga
