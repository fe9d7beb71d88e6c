#include "meshing/layout/cuboid_template.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "iga/core/error.h"
#include "meshing/layout/polycube_templates.h"
#include "meshing/topology/cell_complex.h"

using namespace couture;
using namespace couture::meshing;

namespace {

const std::vector<SectionCell> quad{{0, 0}};
const std::vector<SectionCell> column_of_2{{0, 0}, {0, 1}};
const std::vector<SectionCell> column_of_3{{0, 0}, {0, 1}, {0, 2}};
const std::vector<SectionCell> cross{{0, 1}, {1, 0}, {1, 1}, {1, 2}, {2, 1}};

int count(const std::vector<ArcKind>& kinds, ArcKind kind) {
    return static_cast<int>(std::ranges::count(kinds, kind));
}

}  // namespace

TEST_CASE("cuboid template: pants have the cuboids and nodes of their figures", "[layout]") {
    struct Expected {
        std::vector<SectionCell> section, chain;
        int n_cuboids, n_nodes, n_loop;
    };
    // [Maquart19] Fig. 6.4: 20, 28 and 36 nodes.
    const auto expected = GENERATE(values<Expected>({{quad, {{0, 0}}, 4, 20, 4},
                                                     {column_of_2, {{0, 0}}, 7, 28, 6},
                                                     {column_of_2, column_of_2, 8, 30, 6},
                                                     {column_of_3, {{0, 1}}, 10, 36, 8}}));
    const CuboidTemplate pant = make_bar_template("pant", expected.section, {expected.chain});
    CHECK(pant.layout.n_cuboids() == expected.n_cuboids);
    CHECK(pant.layout.n_nodes == expected.n_nodes);
    CHECK(pant.caps == std::vector<std::string>{"x_low", "x_high", "branch"});
    CHECK(static_cast<int>(cap_pattern(pant, 0).loop.size()) == expected.n_loop);
    CHECK(wall_of(pant).layout.euler_characteristic() == -1);
}

TEST_CASE("cuboid template: the wall of b caps has Euler characteristic 2 - b and their loops",
          "[layout]") {
    std::vector<CuboidTemplate> shapes{
        make_polycube_template("sphere", {{0, 0, 0}}, {}),
        make_disc_template("disc", cross),
        make_bar_template("cylinder", cross, {}),
        make_bar_template("pant", cross, {{{2, 1}}}),
        make_bar_template("shirt", column_of_3, {{{0, 0}}, {{0, 1}, {0, 2}}}),
    };
    for (int legs = 3; legs <= 6; ++legs) shapes.push_back(make_star_template("star", legs));
    for (const CuboidTemplate& shape : shapes) {
        INFO(shape.name << " of " << shape.n_caps());
        const LayoutBoundary wall = wall_of(shape);
        CHECK(wall.layout.euler_characteristic() == 2 - shape.n_caps());
        std::set<std::vector<int>> loops;
        for (auto loop : boundary_loops(wall.layout)) {
            std::reverse(loop.begin() + 1, loop.end());
            loops.insert(loop);
        }
        std::set<std::vector<int>> of_caps;
        for (int cap = 0; cap < shape.n_caps(); ++cap) {
            of_caps.insert(cap_pattern(shape, cap).loop);
        }
        CHECK(loops == of_caps);
    }
}

TEST_CASE("cuboid template: arcs of a pant are convex, flat or reflex as its shape", "[layout]") {
    const CuboidTemplate pant = make_bar_template("pant", quad, {quad});
    const LayoutBoundary boundary = layout_boundary(pant.layout);
    const auto kinds = arc_kinds(pant, boundary);
    // The branch stands on two reflex arcs along z; sectors meet flat at three sides each of two
    // sections less these two, and the branch runs on in the planes z = 0 and z = 1.
    CHECK(count(kinds, ArcKind::reflex) == 2);
    CHECK(count(kinds, ArcKind::flat) == 2 * 3 + 2);
    CHECK(count(kinds, ArcKind::convex) == boundary.layout.n_arcs() - 10);
    const auto is_corner = corner_nodes(pant, boundary);
    // All but those at y = 0 between sectors.
    CHECK(std::ranges::count(is_corner, true) == 16);
    // The caps of the wall stand upright.
    const auto on_wall = arc_kinds(pant, wall_of(pant));
    CHECK(count(on_wall, ArcKind::convex) == boundary.layout.n_arcs() - 10);
}

TEST_CASE("cuboid template: what is no template is refused with its name", "[layout]") {
    const CuboidTemplate tee = make_bar_template("tee", quad, {quad});
    const auto broken = [&](auto change) {
        CuboidTemplate shape = tee;
        change(shape);
        return shape;
    };
    CHECK_THROWS_WITH(check_template(broken([](auto& t) { t.positions.pop_back(); })),
                      "template 'tee': 19 positions for 20 nodes");
    CHECK_THROWS_WITH(
        check_template(broken([](auto& t) { std::swap(t.positions[0], t.positions[1]); })),
        Catch::Contains("template 'tee': cuboid 0 is flat or turned inside out"));
    CHECK_THROWS_WITH(check_template(broken([](auto& t) { t.caps.pop_back(); })),
                      "template 'tee': 2 caps are listed, 2 of them different, and there are 3 "
                      "sets");
    CHECK_THROWS_WITH(
        check_template(broken([](auto& t) {
            t.layout.sets["branch"] = {{3, 2}};
        })),
        "template 'tee': cap 'branch' has side 2 of cuboid 3, which is no outer side");
    CHECK_THROWS_WITH(check_template(broken([](auto& t) {
                          t.layout.sets["branch"] = {{0, 3}};
                      })),
                      Catch::Contains("share node") && Catch::Contains("caps may not touch"));
    CHECK_THROWS_WITH(check_template(broken([](auto& t) {
                          t.layout.sets["branch"] = {{3, 0}, {3, 1}};
                      })),
                      Catch::Contains("cap 'branch': 2 quads have 2 boundary loops"));
    std::vector<GridCell> ring;
    for (int k = 0; k < 9; ++k) {
        if (k != 4) ring.push_back({k % 3, k / 3, 0});
    }
    CHECK_THROWS_WITH(make_polycube_template("ring", ring, {{"top", {{0, 5}}}}),
                      "template 'ring': the cuboids have 1 tunnels and 0 cavities; they must be a "
                      "ball, as a patch of a surface and its caps bound one: open a ring at a pair "
                      "of caps");
    CHECK_THROWS_WITH(make_polycube_template("edge", {{0, 0, 0}, {1, 1, 0}}, {}),
                      Catch::Contains("template 'edge'"));
    CHECK_THROWS_WITH(make_polycube_template("twice", {{0, 0, 0}, {0, 0, 0}}, {}),
                      "template 'twice': cell [0, 0, 0] is there twice");
    CHECK_THROWS_WITH(make_polycube_template("corner", {{0, 0, 0}, {1, 1, 1}}, {}),
                      Catch::Contains("template 'corner'"));
    CHECK_THROWS_WITH(make_bar_template("t", quad, {{{0, 1}}}),
                      "template 't': a branch stands on cell [0, 1], which the section has not");
    CHECK_THROWS_WITH(make_bar_template("t", column_of_3, {{{0, 0}, {0, 2}}}),
                      Catch::Contains("don't follow each other"));
    CHECK_THROWS_WITH(make_bar_template("t", cross, {{{1, 0}}}),
                      Catch::Contains("touches cell [2, 1]"));
    CHECK_THROWS_WITH(make_star_template("s", 7), "template 's': a star has 3 to 6 legs, not 7");
}

TEST_CASE("template library: sorted by caps, then cuboids", "[layout]") {
    TemplateLibrary library;
    library.add(make_star_template("plus", 4));
    library.add(make_bar_template("wide_tee", column_of_2, {{{0, 0}}}));
    library.add(make_bar_template("tee", quad, {quad}));
    library.add(make_polycube_template("ball", {{0, 0, 0}}, {}));
    REQUIRE(library.templates().size() == 4);
    CHECK(library.templates()[0].name == "ball");
    REQUIRE(library.with_caps(3).size() == 2);
    CHECK(library.with_caps(3)[0].name == "tee");
    CHECK(library.with_caps(5).empty());
    CHECK(library.find("plus").layout.n_cuboids() == 5);
    CHECK_THROWS_WITH(library.find("pluss"), "there is no template 'pluss'; did you mean 'plus'?");
    CHECK_THROWS_WITH(library.add(make_star_template("tee", 4)),
                      "template 'tee' is there already; give another name");
}

TEST_CASE("cap patterns: rotations that lay quads on quads", "[layout]") {
    const CuboidTemplate a = make_bar_template("a", cross, {});
    const CuboidTemplate square = make_bar_template("square", quad, {});
    const CuboidTemplate column = make_bar_template("column", column_of_2, {});
    // A square has 4 turns, two squares 2, a cross 4 (of its 12 loop nodes).
    CHECK(admissible_rotations(cap_pattern(square, 0), cap_pattern(square, 1)).size() == 4);
    CHECK(admissible_rotations(cap_pattern(column, 0), cap_pattern(column, 1)).size() == 2);
    CHECK(admissible_rotations(cap_pattern(a, 0), cap_pattern(a, 1)).size() == 4);
    CHECK(admissible_rotations(cap_pattern(a, 0), cap_pattern(column, 1)).empty());
    const CapPattern low = cap_pattern(column, 0);
    const CapPattern high = cap_pattern(column, 1);
    for (const int r : admissible_rotations(low, high)) {
        const auto nodes = match_caps(low, high, r);
        REQUIRE(nodes);
        CHECK(nodes->size() == 6);
        CHECK(nodes->at(low.loop[1]) == high.loop[(r + 5) % 6]);
    }
}

TEST_CASE("make_ring_template: closes on itself with as many sectors as corners, plus one",
          "[layout]") {
    const CuboidTemplate ring = make_ring_template("ring", {{0, 0}}, 4);
    CHECK(ring.layout.n_cuboids() == 5);
    const CapPattern low = cap_pattern(ring, 0);
    // Caps lie on each other, so that the ring has no twist.
    std::set<std::array<double, 3>> places;
    for (int cap = 0; cap < 2; ++cap) {
        for (const int node : cap_pattern(ring, cap).loop) {
            const Vector3& x = ring.positions[node];
            places.insert(
                {std::round(1e9 * x.x()), std::round(1e9 * x.y()), std::round(1e9 * x.z())});
        }
    }
    CHECK(places.size() == low.loop.size());
    CHECK_THROWS_WITH(make_ring_template("flat", {{0, 0}}, 2),
                      Catch::Contains("a ring has 3 corners or more, not 2"));
}
