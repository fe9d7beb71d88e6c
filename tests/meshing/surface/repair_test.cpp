#include "meshing/surface/repair.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "iga/core/error.h"
#include "meshing/topology/invariants.h"
#include "tests/meshing/surface/surface_samples.h"

using namespace couture;
using namespace couture::meshing;

namespace {

void turn(TriangleSoup& soup, int t) { std::swap(soup.triangles[t][1], soup.triangles[t][2]); }

/// Every triangle with points of its own.
TriangleSoup exploded(const TriangleSoup& soup) {
    TriangleSoup result;
    for (const auto& triangle : soup.triangles) {
        const int next = static_cast<int>(result.points.size());
        for (const int v : triangle) result.points.push_back(soup.points[v]);
        result.triangles.push_back({next, next + 1, next + 2});
    }
    return result;
}

}  // namespace

TEST_CASE("repair_surface: a good surface stays as it is", "[meshing][surface]") {
    const TriangleSoup torus = make_torus(12, 8, 2.0, 0.7);
    const RepairedSurface repaired = repair_surface(torus);
    CHECK(repaired.soup.points == torus.points);
    CHECK(repaired.soup.triangles == torus.triangles);
    CHECK_FALSE(repaired.report.has_changed());
}

TEST_CASE("repair_surface: equal points are merged and bad triangles dropped",
          "[meshing][surface]") {
    const TriangleSoup cube = make_cube(2);
    TriangleSoup bad = exploded(cube);
    bad.points.emplace_back(7.0, 7.0, 7.0);
    bad.triangles.push_back({0, 1, 1});
    bad.triangles.push_back({1, 2, 0});
    const RepairedSurface repaired = repair_surface(bad);
    CHECK(repaired.soup.points.size() == cube.points.size());
    CHECK(repaired.soup.triangles.size() == cube.triangles.size());
    CHECK(repaired.report.n_merged == 3 * 48 - 26);
    CHECK(repaired.report.n_degenerate == 1);
    REQUIRE(repaired.report.degenerate.size() == 1);
    CHECK(repaired.report.degenerate[0].triangles == std::vector{48});
    CHECK(repaired.report.n_duplicates == 1);
    REQUIRE(repaired.report.duplicates.size() == 1);
    CHECK(repaired.report.duplicates[0].triangles == std::vector{0, 49});
    CHECK(repaired.report.n_unused == 1);
    CHECK(repaired.report.n_turned == 0);
}

TEST_CASE("repair_surface: of opposite copies one stays where it closes the surface",
          "[meshing][surface]") {
    TriangleSoup copied = make_tetrahedron();
    copied.triangles.push_back(copied.triangles[2]);
    turn(copied, 4);
    CHECK(repair_surface(copied).soup.triangles == make_tetrahedron().triangles);
    // Two cubes with a wall in common: the wall goes.
    const TriangleSoup cube = make_cube(2);
    TriangleSoup shifted = cube;
    for (Vector3& point : shifted.points) point.x() += 1.0;
    const RepairedSurface one = repair_surface(join(cube, shifted));
    CHECK(one.report.n_duplicates == 2 * 8);
    CHECK(one.soup.triangles.size() == 2 * 48 - 16);
    CHECK(orientation_of(one.soup) == Orientation::consistent);
    const SurfaceMesh mesh = make_surface_mesh(one.soup);
    CHECK(signed_volume(mesh) == Approx(2.0));
    CHECK(compute_invariants(mesh).euler_characteristic == 2);
    // Two sheets back to back enclose nothing.
    TriangleSoup lens{.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, .triangles = {{0, 1, 2}}};
    lens.triangles.push_back({0, 2, 1});
    CHECK_THROWS_WITH(repair_surface(lens),
                      "repair_surface: none of 2 triangles is left: 0 had a point twice, 2 lay on "
                      "another one; a surface has at least one");
}

TEST_CASE("repair_surface: triangles are turned as most run", "[meshing][surface]") {
    const TriangleSoup torus = make_torus(12, 8, 2.0, 0.7);
    TriangleSoup mixed = torus;
    for (const int t : {3, 17, 18, 90}) turn(mixed, t);
    const RepairedSurface repaired = repair_surface(mixed);
    CHECK(repaired.soup.triangles.size() == torus.triangles.size());
    CHECK(repaired.report.n_turned == 4);
    CHECK(repaired.turned == std::vector{3, 17, 18, 90});
    CHECK(repaired.report.turned[1].triangles == std::vector{17});
    CHECK(signed_volume(make_surface_mesh(repaired.soup)) ==
          Approx(signed_volume(make_surface_mesh(torus))));
}

TEST_CASE("repair_surface: what can't be oriented is left", "[meshing][surface]") {
    TriangleSoup strip;
    constexpr int n = 9;
    for (int i = 0; i < n; ++i) {
        const double angle = 2.0 * 3.14159265358979 * i / n;
        for (const double side : {-0.3, 0.3}) {
            const double r = 1.0 + side * std::cos(angle / 2.0);
            strip.points.emplace_back(r * std::cos(angle), r * std::sin(angle),
                                      side * std::sin(angle / 2.0));
        }
    }
    for (int i = 0; i < n; ++i) {
        const int a = 2 * i;
        const int b = a + 1;
        const int c = i + 1 < n ? a + 2 : 1;
        const int d = i + 1 < n ? a + 3 : 0;
        strip.triangles.push_back({a, c, b});
        strip.triangles.push_back({b, c, d});
    }
    REQUIRE(orientation_of(strip) == Orientation::impossible);
    const RepairedSurface repaired = repair_surface(strip);
    CHECK(repaired.soup.triangles == strip.triangles);
    CHECK(repaired.report.n_turned == 0);
}

TEST_CASE("repair_surface: numbers that can't be are refused", "[meshing][surface]") {
    TriangleSoup soup = make_tetrahedron();
    soup.triangles[1][2] = 4;
    CHECK_THROWS_WITH(repair_surface(soup),
                      Catch::Contains("triangle 1") && Catch::Contains("must be numbers below 4"));
    soup = make_tetrahedron();
    soup.points[2].y() = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_WITH(repair_surface(soup), Catch::Contains("point 2 is (") &&
                                                Catch::Contains("coordinates must be finite"));
}
