#include "meshing/surface/fix_surface.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "iga/core/error.h"
#include "meshing/surface/hole_filling.h"
#include "meshing/surface/soup_boundary.h"
#include "meshing/topology/invariants.h"
#include "tests/meshing/surface/surface_samples.h"

using namespace couture;
using namespace couture::meshing;

TEST_CASE("fix_surface: near points are welded", "[meshing][surface]") {
    const TriangleSoup cube = make_cube(2);
    TriangleSoup torn;
    for (std::size_t t = 0; t < cube.triangles.size(); ++t) {
        const int next = static_cast<int>(torn.points.size());
        for (const int v : cube.triangles[t]) {
            torn.points.emplace_back(cube.points[v] +
                                     1e-10 * Vector3::Constant(static_cast<double>(t % 5)));
        }
        torn.triangles.push_back({next, next + 1, next + 2});
    }
    const FixedSurface fixed = fix_surface(torn);
    CHECK(fixed.soup.points.size() == cube.points.size());
    CHECK(fixed.soup.triangles.size() == cube.triangles.size());
    CHECK(fixed.report.n_welded == 3 * 48 - 26);
    CHECK(fixed.report.largest_move < 1e-9);
}

TEST_CASE("fix_surface: flat triangles go without a hole", "[meshing][surface]") {
    // Two triangles over a square with a cap on their diagonal.
    TriangleSoup cap{.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 0}},
                     .triangles = {{0, 1, 2}, {0, 2, 4}, {0, 4, 3}, {4, 2, 3}}};
    FixedSurface fixed = fix_surface(cap);
    CHECK(fixed.report.n_flat_removed == 1);
    CHECK(fixed.report.n_flat_left == 0);
    CHECK(fixed.soup.triangles.size() == 4);
    SurfaceMesh mesh = make_surface_mesh(fixed.soup);
    CHECK(surface_area(mesh) == Approx(1.0).epsilon(1e-14));
    CHECK(compute_invariants(mesh).euler_characteristic == 1);
    CHECK(boundary_loops(mesh).size() == 1);
}

TEST_CASE("fix_surface: parts that touch at a vertex get one each", "[meshing][surface]") {
    TriangleSoup two = join(make_tetrahedron(), make_tetrahedron());
    for (int i = 4; i < 8; ++i) two.points[i] = -two.points[i];
    for (int t = 4; t < 8; ++t) {
        std::swap(two.triangles[t][1], two.triangles[t][2]);
        for (int& v : two.triangles[t]) {
            if (two.points[v] == Vector3(-two.points[0])) v = 0;
        }
    }
    two.points[4] = Vector3(9, 9, 9);
    const Vector3 apex = two.points[0];
    for (int i = 5; i < 8; ++i) two.points[i] += 2.0 * apex;
    REQUIRE(corner_fans(two).size() == 24);
    CHECK_THROWS_AS(make_surface_mesh(two), TopologyError);
    const FixedSurface fixed = fix_surface(repair_surface(two).soup);
    CHECK(fixed.report.n_split_vertices == 1);
    REQUIRE(fixed.report.split_vertices.size() == 1);
    CHECK(fixed.report.split_vertices[0].position == apex);
    CHECK(compute_invariants(make_surface_mesh(fixed.soup)).n_components == 2);
}

TEST_CASE("fix_surface: holes are filled only where asked for", "[meshing][surface]") {
    const TriangleSoup tube = make_tube(12, 3, 1.0, 2.0);
    CHECK(fix_surface(tube).soup.triangles.size() == tube.triangles.size());
    const FixedSurface closed = fix_surface(tube, {.fills_holes = true});
    CHECK(closed.report.n_filled_holes == 2);
    CHECK(closed.report.n_hole_triangles == 2 * 10);
    CHECK(closed.report.n_open_holes == 0);
    const SurfaceMesh mesh = make_surface_mesh(closed.soup);
    CHECK(compute_invariants(mesh).euler_characteristic == 2);
    CHECK(compute_invariants(mesh).n_boundaries == 0);
    // A prism over a regular polygon with 12 corners.
    CHECK(signed_volume(mesh) == Approx(6.0 * 2.0 * std::sin(3.14159265358979 / 6.0)));
}

TEST_CASE("fix_surface: options must be small", "[meshing][surface]") {
    CHECK_THROWS_WITH(fix_surface(make_tetrahedron(), {.weld_distance = -1.0}),
                      "fix_surface: weld_distance = -1; it must be at least 0 and below 0.1");
    CHECK_THROWS_WITH(fix_surface(make_tetrahedron(), {.flatness = 0.5}),
                      Catch::Contains("flatness = 0.5"));
    CHECK_THROWS_WITH(fill_loop(std::vector<Vector3>(2)),
                      "fill_loop: 2 points; a loop has three or more");
}

TEST_CASE("open_loops: chains of a torus cut open and of a square", "[meshing][surface]") {
    CHECK(open_loops(make_torus(8, 6, 2.0, 0.5)).empty());
    const auto loops = open_loops(make_tube(12, 3, 1.0, 2.0));
    REQUIRE(loops.size() == 2);
    CHECK(loops[0].vertices.size() == 12);
    CHECK(loops[0].vertices.front() == 0);
    CHECK(loops[0].triangles.size() == 12);
    CHECK(loops[1].is_closed);
    CHECK(open_loops(make_square(3)).at(0).vertices.size() == 12);
}
