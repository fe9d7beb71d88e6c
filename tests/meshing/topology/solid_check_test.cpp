#include "meshing/topology/solid_check.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "iga/core/error.h"
#include "meshing/surface/repair.h"
#include "tests/meshing/surface/surface_samples.h"

using namespace couture;
using namespace couture::meshing;
using Catch::Matchers::Contains;

namespace {

TriangleSoup moved(TriangleSoup soup, double factor, const Vector3& shift) {
    for (Vector3& point : soup.points) point = factor * point + shift;
    return soup;
}

TriangleSoup reversed(TriangleSoup soup) {
    for (auto& triangle : soup.triangles) std::swap(triangle[1], triangle[2]);
    return soup;
}

std::string text_of(const TriangleSoup& soup) {
    std::string text;
    for (const std::string& line : summarize(check_solid(soup))) text += line + "\n";
    return text;
}

}  // namespace

TEST_CASE("check_solid: solids, with cavities too, are clean", "[meshing][topology]") {
    CHECK(check_solid(make_cube(2)).is_clean());
    CHECK(check_solid(make_plate_with_holes(2, 1)).solid->betti == std::array{1, 2, 0});
    const SurfaceCheck hollow =
        check_solid(join(make_cube(2), reversed(moved(make_cube(2), 0.5, {0.2, 0.2, 0.2}))));
    CHECK(hollow.is_clean());
    CHECK(hollow.solid->betti == std::array{1, 0, 1});
    CHECK(hollow.shells.size() == 2);
    CHECK(hollow.shells[1].depth == 1);
}

TEST_CASE("check_solid: open boundaries are loops with lengths", "[meshing][topology]") {
    const SurfaceCheck check = check_solid(make_tube(4, 1, 1.0, 2.0));
    CHECK(check.count(FlawKind::open_boundary) == 2);
    CHECK(check.flaws.size() == 2);
    const SurfaceFlaw& flaw = *check.first(FlawKind::open_boundary);
    CHECK(flaw.is_closed);
    CHECK(flaw.line.size() == 4);
    CHECK(flaw.length == Approx(4.0 * std::sqrt(2.0)));
    CHECK(flaw.position.norm() < 1e-14);
    CHECK_FALSE(check.solid);
    CHECK_THAT(text_of(make_tube(4, 1, 1.0, 2.0)),
               Contains("2 open boundaries:\n") && Contains("loop of 4 edges, length 5.65685"));
}

TEST_CASE("check_solid: edges and vertices that are no manifold", "[meshing][topology]") {
    const TriangleSoup fan{.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}},
                           .triangles = {{0, 1, 2}, {0, 3, 1}, {0, 1, 4}}};
    CHECK_THAT(text_of(fan),
               Contains("1 non-manifold edge:\n  (0.5, 0, 0): edge of vertices 0 and 1 with 3 "
                        "triangles: 0, 1, 2\n"));
    const TriangleSoup bow{.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}},
                           .triangles = {{0, 1, 2}, {0, 3, 4}}};
    CHECK_THAT(text_of(bow), Contains("1 non-manifold vertex:\n  (0, 0, 0): vertex 0 where 2 fans "
                                      "of triangles touch, those of triangles 0, 1\n"));
}

TEST_CASE("check_solid: orientation", "[meshing][topology]") {
    TriangleSoup cube = make_cube(1);
    std::swap(cube.triangles[3][1], cube.triangles[3][2]);
    const SurfaceCheck check = check_solid(cube);
    CHECK(check.count(FlawKind::inconsistent_edge) == 3);
    CHECK_THAT(check.first(FlawKind::inconsistent_edge)->text,
               Contains("run along the edge of vertices") && Contains("in the same direction"));
    CHECK_THAT(text_of(reversed(make_cube(1))),
               Contains("1 inside-out shell:\n  (0.5, 0.5, 0.5): shell 0, whose normals point "
                        "inwards\n"));
    CHECK_THAT(text_of(join(make_cube(1), moved(make_cube(1), 0.5, {0.2, 0.2, 0.2}))),
               Contains("shell 1, whose normals point out of the cavity"));
}

TEST_CASE("check_solid: shells beside each other and solids in cavities", "[meshing][topology]") {
    const TriangleSoup apart = join(make_cube(1), moved(make_cube(1), 0.5, {3, 0, 0}));
    CHECK_THAT(text_of(apart), Contains("1 disjoint shell:\n  (3.25, 0.25, 0.25): shell 1 outside "
                                        "shell 0, 12 triangles, size 0.5 x 0.5 x 0.5\n"));
    CHECK_FALSE(check_solid(apart).solid);
    CHECK(check_solid(select_shell(apart, 1).soup).solid->volume == Approx(0.125));
    CHECK_THROWS_WITH(select_shell(apart, 2),
                      "select_shell: there is no shell 2; there are 2, counted from 0");
    const TriangleSoup hollow =
        join(make_cube(2), reversed(moved(make_cube(2), 0.5, {0.2, 0.2, 0.2})));
    const TriangleSoup nested = join(hollow, moved(make_cube(1), 0.1, {0.4, 0.4, 0.4}));
    CHECK_THAT(text_of(nested), Contains("shell 2 in the cavity of shell 1"));
    CHECK(select_shell(nested, 0).soup.triangles.size() == hollow.triangles.size());
    CHECK_FALSE(select_shell(nested, 0).was_cavity);
    // What is wrong elsewhere takes no cavity away.
    const TriangleSoup beside_open = join(hollow, moved(make_square(1), 1.0, {5, 0, 0}));
    CHECK(select_shell(beside_open, 0).soup.triangles.size() == hollow.triangles.size());
    const SelectedShell inside = select_shell(nested, 1);
    CHECK(inside.was_cavity);
    CHECK(check_solid(inside.soup).solid->volume == Approx(0.125 - 0.001));
    CHECK_THAT(
        text_of(join(make_tube(6, 1, 1.0, 1.0), moved(make_tube(5, 1, 1.0, 1.0), 1.0, {5, 0, 0}))),
        Contains("component 1 beside component 0"));
}

TEST_CASE("check_solid: bad triangles and crossings", "[meshing][topology]") {
    TriangleSoup flat = make_square(1);
    flat.points.emplace_back(0.5, 0.0, 0.0);
    flat.triangles.push_back({0, 4, 1});
    CHECK_THAT(text_of(flat),
               Contains("1 flat triangle:\n") && Contains("its height is 0 of its longest side"));
    TriangleSoup twice = make_cube(1);
    twice.triangles.push_back(twice.triangles[5]);
    CHECK_THAT(text_of(twice), Contains("1 duplicate triangle:\n") &&
                                   Contains("triangles 5, 12 have the same vertices"));
    const TriangleSoup crossing =
        join(make_cube(1), moved(make_cube(1), 1.0, Vector3(0.55, 0.45, 0.35)));
    CHECK_THAT(text_of(crossing), Contains("self-intersections:\n") && Contains("  ...\n"));
    CHECK_THAT(summarize(check_solid(crossing, {.max_crossings = 2})).front(),
               Contains("2 or more self-intersections:"));
    CHECK_THAT(text_of(make_square(1)),
               Contains("1 surface of too few triangles:\n") &&
                   Contains("2 triangles; the least solid, a tetrahedron, has 4"));
    TriangleSoup wrong = make_square(1);
    wrong.triangles[0][0] = 9;
    CHECK_THROWS_WITH(check_solid(wrong), Contains("triangle 0 has vertices 9"));
}

TEST_CASE("check_solid: triangles get the number of their flaw", "[meshing][topology]") {
    const TriangleSoup apart = join(make_cube(1), moved(make_cube(1), 0.5, {3, 0, 0}));
    const auto flaws = flaw_of_triangle(check_solid(apart), apart.triangles.size());
    CHECK(flaws.front() == 0);
    CHECK(flaws.back() == static_cast<int>(FlawKind::disjoint_shell));
    CHECK(to_string(FlawKind::open_boundary) == "open boundary");
}

TEST_CASE("orient_outwards: normals point out of the material", "[meshing][topology]") {
    TriangleSoup hollow =
        reversed(join(make_cube(2), reversed(moved(make_cube(2), 0.5, {0.2, 0.2, 0.2}))));
    CHECK(orient_outwards(hollow) == 2);
    CHECK(check_solid(hollow).is_clean());
    CHECK(orient_outwards(hollow) == 0);
    // An open surface is turned only if its side had to be chosen.
    TriangleSoup tube = reversed(make_tube(8, 2, 1.0, 2.0));
    CHECK(orient_outwards(tube) == 0);
    CHECK(orient_outwards(tube, {0}) == 1);
    CHECK(tube.triangles == make_tube(8, 2, 1.0, 2.0).triangles);
}
