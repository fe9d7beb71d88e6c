#include "meshing/layout/layout_validity.h"

#include <catch2/catch.hpp>

#include "iga/core/error.h"
#include "meshing/layout/polycube_templates.h"
#include "tests/meshing/layout/layout_samples.h"

using namespace couture;
using namespace couture::meshing;
using test::ring_of_cuboids;

namespace {

using Quads = std::vector<std::array<int, 4>>;

/// n_sections loops of n nodes each, one above the other; closed to a torus or not.
QuadLayout tube(int n, int n_sections, bool is_ring) {
    Quads quads;
    const int n_rows = is_ring ? n_sections : n_sections - 1;
    for (int row = 0; row < n_rows; ++row) {
        const int below = row * n;
        const int above = (row + 1) % n_sections * n;
        for (int k = 0; k < n; ++k) {
            const int next = (k + 1) % n;
            quads.push_back({below + k, below + next, above + next, above + k});
        }
    }
    return {n * n_sections, quads};
}

QuadLayout closed_by(const QuadLayout& layout, const CapPattern& pattern) {
    return close_boundaries(layout, {{0, pattern, 0}, {1, pattern, 0}});
}

/// Three quads around a centre: what is left of a triangle whose sides are halved.
const CapPattern hexagon = make_cap_pattern({{0, 1, 6, 5}, {1, 2, 3, 6}, {3, 4, 5, 6}});
const CapPattern one_quad = make_cap_pattern({{0, 1, 2, 3}});

}  // namespace

TEST_CASE("judge_layout: the corrected boundary term counts a single quad as a disc", "[layout]") {
    const QuadLayout quad(4, {{0, 1, 2, 3}});
    CHECK(judge_layout(quad, 1).is_cuboid_configuration);
    const LayoutVerdict wrong = judge_layout(quad, 0);
    CHECK_FALSE(wrong.is_quad_layout);
    CHECK(wrong.reason ==
          "sum of (1 - valence/4) over inner and of (3 - valence)/4 over boundary nodes = 1, "
          "expected Euler characteristic 0; first irregular node: 0 (on the boundary, valence 2)");
}

// [Maquart19] Fig. 6.5.
TEST_CASE("judge_layout: A, a triangular cylinder, is a layout but bounds no cuboids", "[layout]") {
    const LayoutVerdict verdict = judge_layout(tube(3, 2, false), 0);
    CHECK(verdict.is_quad_layout);
    CHECK_FALSE(verdict.is_cuboid_configuration);
    CHECK(verdict.reason ==
          "the boundary loop of 3 nodes (0, 1, 2) bounds inside; such a cycle has an even number "
          "of nodes, at least 4");
    CHECK_THROWS_WITH(closed_by(tube(3, 2, false), one_quad),
                      "the boundary loop of 3 nodes (0, 1, 2) can't be closed by a pattern of 4 "
                      "nodes");
    CHECK_FALSE(judge_layout(tube(5, 2, false), 0).is_cuboid_configuration);
}

TEST_CASE("judge_layout: B, a torus with three nodes around its section, is refused", "[layout]") {
    const LayoutVerdict verdict = judge_layout(tube(3, 4, true), 0, {{0, 1, 2}});
    CHECK(verdict.is_quad_layout);
    CHECK_FALSE(verdict.is_cuboid_configuration);
    CHECK(verdict.reason ==
          "the cycle of 3 nodes (0, 1, 2) bounds inside; such a cycle has an even number of nodes, "
          "at least 4");
    CHECK(judge_layout(tube(3, 5, true), 0).reason ==
          "15 quads bound the volume; cuboids have an even number outside");
}

TEST_CASE("judge_layout: C and F, a closed cylinder of 12 nodes, is one of combinatorics",
          "[layout]") {
    const QuadLayout cylinder = closed_by(tube(4, 3, false), one_quad);
    CHECK(cylinder.n_nodes() == 12);
    const LayoutVerdict verdict = judge_layout(cylinder, 2);
    CHECK(verdict.is_cuboid_configuration);
    CHECK(verdict.reason.empty());
}

TEST_CASE("judge_layout: D, the triangular cylinder with its sides halved, is filled by three",
          "[layout]") {
    CHECK(judge_layout(tube(6, 2, false), 0).is_cuboid_configuration);
    const QuadLayout closed = closed_by(tube(6, 2, false), hexagon);
    CHECK(closed.n_nodes() == 14);
    CHECK(judge_layout(closed, 2).is_cuboid_configuration);
    VolumetricLayout three;
    three.n_nodes = 14;
    for (const auto& q : hexagon.quads) {
        three.cuboids.push_back({q[0], q[1], q[3], q[2], q[0] + 7, q[1] + 7, q[3] + 7, q[2] + 7});
    }
    CHECK(layout_boundary(three).layout.n_quads() == closed.n_quads());
    CHECK(volume_topology(three).genera == std::vector{0});
}

TEST_CASE("judge_layout: E, a ring with four nodes around its section; its tunnel may be odd",
          "[layout]") {
    for (const int n_sections : {3, 4, 5}) {
        INFO(n_sections);
        CHECK(judge_layout(tube(4, n_sections, true), 0, {{0, 1, 2, 3}}).is_cuboid_configuration);
        const VolumetricLayout ring = ring_of_cuboids(n_sections);
        CHECK(
            judge_layout(layout_boundary(ring).layout, 0, {{0, 1, 3, 2}}).is_cuboid_configuration);
        const VolumeTopology topology = volume_topology(ring);
        CHECK(topology.chi == 0);
        CHECK(topology.betti == std::vector{1, 1, 0, 0});
        CHECK(topology.genera == std::vector{1});
    }
}

// [Maquart19] Fig. 6.4.
TEST_CASE("judge_layout: closed templates of 20, 28 and 36 nodes are valid", "[layout]") {
    for (const auto& shape : {make_bar_template("20", {{0, 0}}, {{{0, 0}}}),
                              make_bar_template("28", {{0, 0}, {0, 1}}, {{{0, 0}}}),
                              make_bar_template("36", {{0, 0}, {0, 1}, {0, 2}}, {{{0, 1}}})}) {
        INFO(shape.name);
        CHECK(std::to_string(shape.layout.n_nodes) == shape.name);
        CHECK(judge_layout(layout_boundary(shape.layout).layout, 2).is_cuboid_configuration);
        CHECK(judge_layout(wall_of(shape).layout, -1).is_cuboid_configuration);
        const VolumeTopology topology = volume_topology(shape.layout);
        CHECK(topology.chi == 1);
        CHECK(topology.betti == std::vector{1, 0, 0, 0});
    }
}

TEST_CASE("judge_layout: nodes that are no manifold's are named", "[layout]") {
    const QuadLayout touching(7, {{0, 1, 2, 3}, {0, 4, 5, 6}});
    CHECK(judge_layout(touching, 1).reason ==
          "quads touch at node 0 only; around a node they form one fan");
    const QuadLayout pillow(4, {{0, 1, 2, 3}, {3, 2, 1, 0}});
    CHECK(judge_layout(pillow, 2).reason == "inner node 0 has 2 arcs; at least 3 must meet");
    CHECK_THROWS_WITH(judge_layout(tube(4, 3, true), 0, {{0, 1, 6}}),
                      "nodes 1 and 6 of the cycle (0, 1, 6) have no arc between them");
    CHECK_THROWS_AS(close_boundaries(tube(4, 2, false), {{2, one_quad, 0}}), InputError);
}

TEST_CASE("volume_topology: a cavity counts with its own genus; touching cuboids are refused",
          "[layout]") {
    std::vector<GridCell> cells;
    for (int i = 0; i < 27; ++i) {
        if (i != 13) cells.push_back({i % 3, i / 3 % 3, i / 9});
    }
    const VolumeTopology hollow =
        volume_topology(make_polycube_template("hollow", cells, {}).layout);
    CHECK(hollow.chi == 2);
    CHECK(hollow.betti == std::vector{1, 0, 1, 0});
    CHECK(hollow.genera == std::vector{0, 0});
    VolumetricLayout touching{15, {{0, 1, 2, 3, 4, 5, 6, 7}, {7, 8, 9, 10, 11, 12, 13, 14}}, {}};
    CHECK_THROWS_WITH(volume_topology(touching),
                      "the boundary of the cuboids touches itself at node 7");
}
