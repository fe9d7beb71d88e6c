#include "meshing/layout/padded_ties.h"

#include <catch2/catch.hpp>
#include <set>

#include "iga/core/error.h"
#include "meshing/layout/polycube_templates.h"

using namespace couture;
using namespace couture::meshing;

namespace {

VolumetricLayout bar_of_two() {
    VolumetricLayout bar = make_polycube_template("bar", {{0, 0, 0}, {0, 0, 1}}, {}).layout;
    for (int n = 0; n < bar.n_nodes; ++n) bar.node_names.push_back(fmt::format("n{}", n));
    return bar;
}

// One tie for each of some arcs.
std::vector<LayoutTie> ties_along(const std::vector<std::array<int, 2>>& arcs) {
    std::vector<LayoutTie> ties;
    for (const auto& [from, to] : arcs) {
        ties.push_back({.vertices = {},
                        .nodes = {from, to},
                        .is_feature = true,
                        .is_blunt = false,
                        .name = fmt::format("edge {}-{}", from, to)});
    }
    return ties;
}

}  // namespace

TEST_CASE("pad_with_ties: a layout whose sharp arcs are all tied stays as it is", "[layout]") {
    const VolumetricLayout bar = bar_of_two();
    std::vector<std::array<int, 2>> arcs;
    const LayoutBoundary boundary = layout_boundary(bar);
    for (int a = 0; a < boundary.layout.n_arcs(); ++a) {
        const auto& [left, right] = boundary.layout.arc_quads(a);
        if (boundary.sides[left.quad].side == boundary.sides[right.quad].side) continue;
        arcs.push_back({boundary.layout.arcs()[a].from, boundary.layout.arcs()[a].to});
    }
    const PaddedTies padded = pad_with_ties(bar, ties_along(arcs));
    CHECK(padded.volume.cuboids == bar.cuboids);
    for (std::size_t t = 0; t < arcs.size(); ++t) {
        CHECK(padded.ties[t].nodes == std::vector<int>{arcs[t][0], arcs[t][1]});
    }
}

TEST_CASE("pad_with_ties: ties keep their nodes in place, along arcs, apart from each other",
          "[layout]") {
    // Both ends are sharp, the wall is smooth: an O-grid.
    const VolumetricLayout bar = bar_of_two();
    std::vector<std::array<int, 2>> arcs;
    const LayoutBoundary boundary = layout_boundary(bar);
    for (int a = 0; a < boundary.layout.n_arcs(); ++a) {
        const auto& [left, right] = boundary.layout.arc_quads(a);
        const auto is_end = [&](int quad) { return boundary.sides[quad].side >= 4; };
        if (is_end(left.quad) == is_end(right.quad)) continue;
        arcs.push_back({boundary.layout.arcs()[a].from, boundary.layout.arcs()[a].to});
    }
    REQUIRE(arcs.size() == 8);
    const PaddedTies padded = pad_with_ties(bar, ties_along(arcs));
    CHECK(padded.volume.n_cuboids() == 10);
    const QuadLayout outside = layout_boundary(padded.volume).layout;
    for (std::size_t t = 0; t < arcs.size(); ++t) {
        const std::vector<int>& nodes = padded.ties[t].nodes;
        CHECK(nodes.front() == padded.node_in_place[arcs[t][0]]);
        CHECK(nodes.back() == padded.node_in_place[arcs[t][1]]);
        for (std::size_t k = 0; k + 1 < nodes.size(); ++k) {
            CHECK(outside.find_arc(nodes[k], nodes[k + 1]) >= 0);
        }
        // Names go with the places.
        CHECK(outside.node_name(nodes.front()) == fmt::format("'n{}'", arcs[t][0]));
    }
}

TEST_CASE("pad_with_ties: a tie that sheets leave no way is named", "[layout]") {
    // One of many patterns of sharp and smooth arcs on two cuboids at which it happens.
    const std::vector<std::array<int, 2>> arcs{{0, 1},  {0, 3},  {0, 6},  {1, 7}, {3, 4},
                                               {4, 10}, {6, 7},  {6, 9},  {7, 8}, {7, 10},
                                               {8, 11}, {9, 10}, {10, 11}};
    CHECK_THROWS_WITH(pad_with_ties(bar_of_two(), ties_along(arcs)),
                      Catch::Contains("layout: edge ") &&
                          Catch::Contains("padding leaves no way from node 'n") &&
                          Catch::Contains("clear of other sharp edges"));
}
