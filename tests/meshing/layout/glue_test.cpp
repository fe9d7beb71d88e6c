#include "meshing/layout/glue.h"

#include <catch2/catch.hpp>

#include "iga/core/error.h"
#include "meshing/layout/layout_validity.h"
#include "meshing/layout/polycube_templates.h"

using namespace couture;
using namespace couture::meshing;

namespace {

const CuboidTemplate tee = make_bar_template("tee", {{0, 0}}, {{{0, 0}}});
const CuboidTemplate wide_tee = make_bar_template("wide_tee", {{0, 0}, {0, 1}}, {{{0, 0}}});
const CuboidTemplate cylinder = make_bar_template("cylinder", {{0, 0}}, {});
enum Cap { x_low, x_high, branch };

}  // namespace

TEST_CASE("glue_templates: two tees become a ring with two arms", "[layout]") {
    const int rotation = GENERATE(0, 1, 2, 3);
    const GluedLayout ring = glue_templates(
        {tee, tee}, {{{0, x_high}, {1, x_low}, rotation}, {{0, x_low}, {1, x_high}, 0}});
    CHECK(ring.layout.n_cuboids() == 8);
    CHECK(ring.layout.n_nodes == 2 * 20 - 2 * 4);
    CHECK(ring.first_cuboid == std::vector{0, 4});
    CHECK(ring.nodes[0][7] == 7);
    REQUIRE(ring.layout.sets.size() == 2);
    CHECK(ring.layout.sets.at("0.branch") == std::vector<CuboidSide>{{3, 3}});
    CHECK(ring.layout.sets.at("1.branch") == std::vector<CuboidSide>{{7, 3}});
    const VolumeTopology topology = volume_topology(ring.layout);
    CHECK(topology.genera == std::vector{1});
    CHECK(topology.betti == std::vector{1, 1, 0, 0});
    CHECK(judge_layout(layout_boundary(ring.layout).layout, 0).is_cuboid_configuration);
}

TEST_CASE("glue_templates: four tees, each at each other, have genus 3", "[layout]") {
    const GluedLayout body = glue_templates({tee, tee, tee, tee}, {{{0, 0}, {1, 0}},
                                                                   {{0, 1}, {2, 0}},
                                                                   {{0, 2}, {3, 0}},
                                                                   {{1, 1}, {2, 1}},
                                                                   {{1, 2}, {3, 1}},
                                                                   {{2, 2}, {3, 2}}});
    CHECK(body.layout.sets.empty());
    CHECK(body.layout.n_cuboids() == 16);
    const VolumeTopology topology = volume_topology(body.layout);
    CHECK(topology.chi == -2);
    CHECK(topology.genera == std::vector{3});
}

TEST_CASE("glue_templates: inner nodes of a pattern are glued as well", "[layout]") {
    std::vector<SectionCell> square;
    for (int i = 0; i < 9; ++i) square.push_back({i / 3, i % 3});
    const CuboidTemplate bar = make_bar_template("bar", square, {});
    const auto rotations = admissible_rotations(cap_pattern(bar, 1), cap_pattern(bar, 0));
    CHECK(rotations.size() == 4);
    const GluedLayout two = glue_templates({bar, bar}, {{{0, 1}, {1, 0}, rotations[1]}});
    CHECK(two.layout.n_nodes == 3 * 16);
    CHECK(volume_topology(two.layout).chi == 1);
}

TEST_CASE("glue_templates: what does not fit is named", "[layout]") {
    CHECK_THROWS_WITH(glue_templates({tee, wide_tee}, {{{0, x_high}, {1, x_low}, 0}}),
                      "joint 0: cap 'x_high' of patch 0 (template 'tee') with 1 quads and 4 nodes "
                      "around does not match cap 'x_low' of patch 1 (template 'wide_tee') with 2 "
                      "and 6 at rotation 0; it would at none");
    const auto rotations = admissible_rotations(cap_pattern(wide_tee, 1), cap_pattern(wide_tee, 0));
    REQUIRE(rotations.size() == 2);
    CHECK_THROWS_WITH(
        glue_templates({wide_tee, wide_tee}, {{{0, x_high}, {1, x_low}, rotations[0] + 1}}),
        Catch::Contains(fmt::format("it would at {}, {}", rotations[0], rotations[1])));
    CHECK_THROWS_WITH(
        glue_templates({tee, tee}, {{{0, x_high}, {1, x_low}, 0}, {{0, x_high}, {1, x_high}, 0}}),
        "joint 1 uses cap 'x_high' of patch 0 (template 'tee') again; a cap is "
        "joined once");
    CHECK_THROWS_AS(glue_templates({tee}, {{{0, 3}, {1, 0}, 0}}), InputError);
}

TEST_CASE("glue_templates: a ring of less than three cuboids would have double arcs", "[layout]") {
    const CapPattern high = cap_pattern(cylinder, x_high);
    const CapPattern low = cap_pattern(cylinder, x_low);
    const auto ring = [&](int n, int rotation) {
        std::vector<CapJoint> joints;
        for (int p = 0; p < n; ++p) joints.push_back({{p, x_high}, {(p + 1) % n, x_low}, rotation});
        return glue_templates(std::vector(n, cylinder), joints);
    };
    // Not turned: nodes come to lie on those at the same y and z.
    int straight = 0;
    while (match_caps(high, low, straight)->at(high.loop[0]) != high.loop[0] - 4) ++straight;
    CHECK_THROWS_WITH(ring(1, straight), Catch::Contains("would be the same: joints stand too"));
    CHECK_THROWS_WITH(ring(1, (straight + 1) % 4),
                      Catch::Contains("nodes 0 and 1 of patch 0 (template 'cylinder') would be the "
                                      "ends of two different arcs"));
    CHECK_THROWS_WITH(ring(2, straight), Catch::Contains("the ends of two different arcs"));
    CHECK(volume_topology(ring(3, straight).layout).genera == std::vector{1});
}
