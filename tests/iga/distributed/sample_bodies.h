#pragma once

#include <numbers>

#include "iga/spline/shapes.h"
#include "iga/topology/interface_match.h"
#include "tests/iga/topology/test_patches.h"

namespace couture::iga {

/// Three boxes in a row along x, the second and third with permuted and reversed directions; sets
/// "left" and "right" at the ends, "bottom" along all.
inline MultiPatch<3> three_turned_boxes() {
    const auto box = [](int i) { return make_unit_box<3>(2, 2, Vector3(i, 0.0, 0.0)); };
    MultiPatch<3> body{{box(0), reoriented<3>(box(1), {2, 0, 1}, {true, false, true}),
                        reoriented<3>(box(2), {1, 0, 2}, {false, true, false})},
                       {},
                       {}};
    (void)find_interfaces(body);
    for (const PatchEntity<3>& side : body.outer_sides()) {
        const MatrixX& points = body.patches[side.patch].control_points();
        Vector3 low = Vector3::Constant(1e9);
        Vector3 high = Vector3::Constant(-1e9);
        for (const int i : functions_on<3>(body.patches[side.patch].space(), side.position)) {
            low = low.cwiseMin(points.row(i).transpose());
            high = high.cwiseMax(points.row(i).transpose());
        }
        if (high[0] < 1e-9) {
            body.boundary_sets["left"].push_back(side);
        } else if (low[0] > 3.0 - 1e-9) {
            body.boundary_sets["right"].push_back(side);
        } else if (high[2] < 1e-9) {
            body.boundary_sets["bottom"].push_back(side);
        }
    }
    return body;
}

/// A whole ring of two rational patches, half an annulus each; set "rim" outside.
inline MultiPatch<2> ring_of_two() {
    const auto half = [](double start) {
        return make_ruled(make_arc(1.0, start, std::numbers::pi),
                          make_arc(2.0, start, std::numbers::pi));
    };
    MultiPatch<2> ring{{half(0.0), half(std::numbers::pi)}, {}, {}};
    (void)find_interfaces(ring);
    ring.boundary_sets["rim"] = {make_side<2>(0, 3), make_side<2>(1, 3)};
    return ring;
}

/// The octant of a spherical shell, whose side at the pole collapses to an edge; sets "inside",
/// "equator".
inline MultiPatch<3> collapsed_wedge() {
    MultiPatch<3> shell{{make_sphere_shell_patch(1.0, 2.0)}, {}, {}};
    shell.boundary_sets = {{"inside", {make_side<3>(0, 0)}}, {"equator", {make_side<3>(0, 3)}}};
    return shell;
}

}  // namespace couture::iga
