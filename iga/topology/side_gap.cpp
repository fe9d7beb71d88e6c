#include "iga/topology/side_gap.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "iga/spline/refine.h"
#include "iga/topology/snap_knots.h"

namespace couture::iga {

namespace {

/// Compares row here[i] of the first with row there[i] of the second control net.
template <int m>
SideGap net_gap(const Patch<m>& first, const std::vector<int>& here, const Patch<m>& second,
                const std::vector<int>& there) {
    assert(here.size() == there.size());
    const auto ratio = [&](std::size_t i) {
        const double w_first = first.is_rational() ? first.weights()[here[i]] : 1.0;
        const double w_second = second.is_rational() ? second.weights()[there[i]] : 1.0;
        return w_first / w_second;
    };
    double factor = 0.0;
    for (std::size_t i = 0; i < here.size(); ++i) {
        factor += ratio(i) / static_cast<double>(here.size());
    }
    SideGap gap;
    for (std::size_t i = 0; i < here.size(); ++i) {
        const double distance =
            (first.control_points().row(here[i]) - second.control_points().row(there[i])).norm();
        gap.distance = std::max(gap.distance, distance);
        gap.weight = std::max(gap.weight, std::abs(ratio(i) / factor - 1.0));
    }
    return gap;
}

template <int m>
TensorSpace<m> tensor_space(const std::vector<KnotVector>& knots) {
    if constexpr (m == 1) {
        return {{knots[0]}};
    } else {
        return {{knots[0], knots[1]}};
    }
}

/// The side as a patch of its own: these knots and the control points `functions`.
template <int d>
Patch<d - 1> side_patch(const Patch<d>& patch, const std::vector<KnotVector>& knots,
                        const std::vector<int>& functions) {
    MatrixX points(functions.size(), patch.dimension());
    VectorX weights(patch.is_rational() ? functions.size() : 0);
    for (std::size_t i = 0; i < functions.size(); ++i) {
        points.row(i) = patch.control_points().row(functions[i]);
        if (patch.is_rational()) {
            weights[i] = patch.weights()[functions[i]];
        }
    }
    return {tensor_space<d - 1>(knots), std::move(points), std::move(weights)};
}

}  // namespace

template <int d>
SideGap side_gap(const Patch<d>& first, const Patch<d>& second, const Interface<d>& interface) {
    const std::vector<int> here =
        functions_on<d>(first.space(), make_side<d>(0, interface.first_side).position);
    const std::vector<int> there = matching_functions(second.space(), interface);
    if (!nonconforming_direction(first.space(), second.space(), interface)) {
        return net_gap<d>(first, here, second, there);
    }
    const std::array<int, d - 1> tangents_here = tangential_directions<d>(interface.first_side);
    const std::array<int, d - 1> tangents_there = tangential_directions<d>(interface.second_side);
    std::vector<KnotVector> knots_here;
    std::vector<KnotVector> knots_there;
    std::vector<KnotVector> common;
    for (int i = 0; i < d - 1; ++i) {
        const KnotVector& own = second.knots(tangents_there[interface.map.axis[i]]);
        const KnotVector oriented = interface.map.reversed[i] ? own.reversed() : own;
        knots_here.push_back(first.knots(tangents_here[i]));
        knots_there.push_back(snap_knots(
            oriented.rescaled(knots_here[i].front(), knots_here[i].back()), knots_here[i]));
        common.push_back(common_refinement(knots_here[i], knots_there[i]));
    }
    const TensorSpace<d - 1> space = tensor_space<d - 1>(common);
    const Patch<d - 1> refined_here =
        refine_to<d - 1>(side_patch<d>(first, knots_here, here), space);
    const Patch<d - 1> refined_there =
        refine_to<d - 1>(side_patch<d>(second, knots_there, there), space);
    std::vector<int> all(space.n_basis());
    for (std::size_t i = 0; i < all.size(); ++i) {
        all[i] = static_cast<int>(i);
    }
    return net_gap<d - 1>(refined_here, all, refined_there, all);
}

template SideGap side_gap(const Patch<2>&, const Patch<2>&, const Interface<2>&);
template SideGap side_gap(const Patch<3>&, const Patch<3>&, const Interface<3>&);

}  // namespace couture::iga
