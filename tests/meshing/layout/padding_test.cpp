#include "meshing/layout/padding.h"

#include <catch2/catch.hpp>
#include <random>
#include <set>

#include "iga/core/error.h"
#include "meshing/layout/layout_validity.h"
#include "meshing/layout/polycube_templates.h"
#include "tests/meshing/layout/layout_samples.h"

using namespace couture;
using namespace couture::meshing;

namespace {

const std::vector<SectionCell> quad{{0, 0}};

/// Smooth everywhere but around the caps.
std::vector<bool> smooth_wall(const VolumetricLayout& layout) {
    std::set<CuboidSide> caps;
    for (const auto& [name, sides] : layout.sets) caps.insert(sides.begin(), sides.end());
    const LayoutBoundary boundary = layout_boundary(layout);
    std::vector<bool> is_smooth;
    for (int a = 0; a < boundary.layout.n_arcs(); ++a) {
        const auto& [left, right] = boundary.layout.arc_quads(a);
        is_smooth.push_back(caps.contains(boundary.sides[left.quad]) ==
                            caps.contains(boundary.sides[right.quad]));
    }
    return is_smooth;
}

/// What holds of every padding.
void check_padding(const VolumetricLayout& old, const PaddedLayout& padded) {
    CHECK(flat_arcs(padded.layout, padded.is_smooth).empty());
    const VolumeTopology before = volume_topology(old);
    const VolumeTopology after = volume_topology(padded.layout);
    CHECK(before.chi == after.chi);
    CHECK(before.betti == after.betti);
    CHECK(before.genera == after.genera);
    const LayoutBoundary boundary = layout_boundary(padded.layout);
    std::set<CuboidSide> sides;
    for (const auto& [old_side, side] : padded.side_in_place) sides.insert(side);
    for (const auto& [strip, old_side] : padded.strips) {
        CHECK(padded.side_in_place.contains(old_side));
        sides.insert(strip);
    }
    CHECK(sides.size() == padded.side_in_place.size() + padded.strips.size());
    CHECK(sides == std::set<CuboidSide>(boundary.sides.begin(), boundary.sides.end()));
    std::set<int> nodes(padded.node_in_place.begin(), padded.node_in_place.end());
    CHECK(static_cast<int>(nodes.size()) == old.n_nodes);
}

int n_arcs(const VolumetricLayout& layout) { return layout_boundary(layout).layout.n_arcs(); }

}  // namespace

TEST_CASE("pad_layout: a smooth ball of one cuboid becomes seven", "[layout]") {
    const VolumetricLayout ball = make_polycube_template("ball", {{0, 0, 0}}, {}).layout;
    const std::vector<bool> is_smooth(n_arcs(ball), true);
    CHECK(flat_arcs(ball, is_smooth).size() == 12);
    const PaddedLayout padded = pad_layout(ball, is_smooth);
    CHECK(padded.layout.n_cuboids() == 7);
    CHECK(padded.layout.n_nodes == 16);
    CHECK(padded.strips.empty());
    check_padding(ball, padded);
}

// [Maquart19] Fig. 6.5 C.
TEST_CASE("pad_layout: a cylinder gets an O-grid, its caps five quads", "[layout]") {
    const VolumetricLayout cylinder = make_bar_template("cylinder", quad, {}).layout;
    const PaddedLayout padded = pad_layout(cylinder, smooth_wall(cylinder));
    CHECK(padded.layout.n_cuboids() == 5);
    check_padding(cylinder, padded);
    for (const char* name : {"x_low", "x_high"}) {
        const CapPattern cap =
            make_cap_pattern(quads_of(padded.layout, padded.layout.sets.at(name)));
        CHECK(cap.quads.size() == 5);
        REQUIRE(cap.loop.size() == 4);
        for (const int node : cap.loop) CHECK(node >= cylinder.n_nodes);
    }
    // Twelve nodes: two such cuboids, valid in combinatorics, with four flat arcs each.
    VolumetricLayout twelve = make_polycube_template("twelve", {{0, 0, 0}, {1, 0, 0}},
                                                     {{"low", {{0, 0}}}, {"high", {{1, 1}}}})
                                  .layout;
    CHECK(judge_layout(layout_boundary(twelve).layout, 2).is_cuboid_configuration);
    CHECK(flat_arcs(twelve, smooth_wall(twelve)).size() == 8);
    CHECK(pad_layout(twelve, smooth_wall(twelve)).layout.n_cuboids() == 10);
}

TEST_CASE("pad_layout: a smooth ring of three becomes fifteen", "[layout]") {
    const VolumetricLayout ring = test::ring_of_cuboids(3);
    const PaddedLayout padded = pad_layout(ring, std::vector<bool>(n_arcs(ring), true));
    CHECK(padded.layout.n_cuboids() == 15);
    check_padding(ring, padded);
}

TEST_CASE("pad_layout: a smooth pant is padded below its wall", "[layout]") {
    const VolumetricLayout tee = make_bar_template("tee", quad, {quad}).layout;
    const PaddedLayout padded = pad_layout(tee, smooth_wall(tee));
    CHECK(padded.layout.n_cuboids() == 4 + 15);
    CHECK(padded.n_sheets == 1);
    check_padding(tee, padded);
    for (const auto& [name, sides] : padded.layout.sets) CHECK(sides.size() == 5);
    CHECK(padded.strips.size() == 12);
}

TEST_CASE("pad_layout: a layout whose arcs are sharp stays as it is", "[layout]") {
    const VolumetricLayout tee = make_bar_template("tee", quad, {quad}).layout;
    const PaddedLayout sharp = pad_layout(tee, std::vector<bool>(n_arcs(tee), false));
    CHECK(sharp.layout.cuboids == tee.cuboids);
    CHECK(sharp.layout.sets == tee.sets);
    CHECK(sharp.n_sheets == 0);
    check_padding(tee, sharp);
    CHECK_THROWS_AS(pad_layout(tee, {true}), InputError);
}

TEST_CASE("pad_layout: only smooth parts with flat arcs are padded", "[layout]") {
    // A bar whose edge along y = z = 0 is rounded.
    const VolumetricLayout bar =
        make_polycube_template("bar", {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {}).layout;
    const LayoutBoundary boundary = layout_boundary(bar);
    std::vector<bool> is_smooth;
    for (int a = 0; a < boundary.layout.n_arcs(); ++a) {
        const auto& [left, right] = boundary.layout.arc_quads(a);
        const int first = boundary.sides[left.quad].side;
        const int second = boundary.sides[right.quad].side;
        is_smooth.push_back(first == second || std::minmax({first, second}) == std::pair(2, 4));
    }
    CHECK(flat_arcs(bar, is_smooth).size() == 3);
    const PaddedLayout padded = pad_layout(bar, is_smooth);
    CHECK(padded.layout.n_cuboids() == 3 + 6);
    check_padding(bar, padded);
}

TEST_CASE("pad_layout: sheets that would touch at a node, or turn within a smooth part",
          "[layout]") {
    // Two by two cuboids; sides 5 are on top.
    const VolumetricLayout block =
        make_polycube_template("block", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {}).layout;
    const LayoutBoundary boundary = layout_boundary(block);
    const auto smooth_at = [&](const std::set<std::pair<CuboidSide, CuboidSide>>& pairs) {
        std::vector<bool> is_smooth;
        for (int a = 0; a < boundary.layout.n_arcs(); ++a) {
            const auto& [left, right] = boundary.layout.arc_quads(a);
            is_smooth.push_back(
                pairs.contains(std::minmax(boundary.sides[left.quad], boundary.sides[right.quad])));
        }
        return is_smooth;
    };
    const auto diagonal = smooth_at({{{0, 0}, {0, 5}}, {{3, 1}, {3, 5}}});
    CHECK(flat_arcs(block, diagonal).size() == 2);
    const PaddedLayout joined = pad_layout(block, diagonal);
    CHECK(joined.layout.n_cuboids() == 4 + 6);
    check_padding(block, joined);
    CHECK_THROWS_WITH(insert_sheet(block, {{0, 5}, {3, 5}}, diagonal),
                      Catch::Contains("a sheet touches itself at node"));
    CHECK_THROWS_WITH(insert_sheet(block, {{0, 1}}, diagonal),
                      "a sheet below side 1 of cuboid 0, which is no outer side");

    const auto turning = smooth_at({{{0, 0}, {0, 5}}, {{1, 5}, {3, 5}}, {{2, 5}, {3, 5}}});
    CHECK(flat_arcs(block, turning).size() == 1);
    const PaddedLayout twice = pad_layout(block, turning);
    CHECK(twice.n_sheets == 2);
    check_padding(block, twice);
}

TEST_CASE("pad_layout: no flat arc is left of any smooth parts of random polycubes", "[layout]") {
    std::mt19937 random(3);
    int most_sheets = 0;
    for (int trial = 0; trial < 300; ++trial) {
        std::set<GridCell> cells{{0, 0, 0}};
        while (cells.size() < 8) {
            GridCell next = *std::next(cells.begin(), static_cast<int>(random() % cells.size()));
            next[random() % 3] += 1;
            cells.insert(next);
        }
        CuboidTemplate shape;
        try {
            shape = make_polycube_template("random", {cells.begin(), cells.end()}, {});
        } catch (const TopologyError&) {
            continue;  // touches itself at an arc or node
        }
        // Sides of equal colour meet smoothly.
        const QuadLayout layout = layout_boundary(shape.layout).layout;
        const auto n_colours = 2 + random() % 3;
        std::vector<std::size_t> colour;
        for (int q = 0; q < layout.n_quads(); ++q) colour.push_back(random() % n_colours);
        std::vector<bool> is_smooth;
        for (int a = 0; a < layout.n_arcs(); ++a) {
            const auto& [left, right] = layout.arc_quads(a);
            is_smooth.push_back(colour[left.quad] == colour[right.quad]);
        }
        INFO(trial);
        const PaddedLayout padded = pad_layout(shape.layout, is_smooth);
        check_padding(shape.layout, padded);
        most_sheets = std::max(most_sheets, padded.n_sheets);
    }
    CHECK(most_sheets >= 2);
}
