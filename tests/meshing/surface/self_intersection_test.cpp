#include "meshing/surface/self_intersection.h"

#include <catch2/catch.hpp>
#include <chrono>

#include "iga/core/error.h"
#include "tests/meshing/surface/surface_samples.h"

using namespace couture;
using namespace couture::meshing;

namespace {

TriangleSoup moved(TriangleSoup soup, double factor, const Vector3& shift) {
    for (Vector3& point : soup.points) point = factor * point + shift;
    return soup;
}

}  // namespace

TEST_CASE("find_self_intersections: closed and open surfaces have none", "[meshing][surface]") {
    CHECK(find_self_intersections(make_torus(20, 12, 2.0, 0.7)).crossings.empty());
    CHECK(find_self_intersections(make_square(6)).crossings.empty());
    CHECK(find_self_intersections(make_plate_with_holes(2, 3)).crossings.empty());
    CHECK(find_self_intersections({}).crossings.empty());
}

TEST_CASE("find_self_intersections: pairs and places are those of two triangles",
          "[meshing][surface]") {
    // The second one stands on the first, through its inside at (0.25, 0.25, 0).
    TriangleSoup soup{
        .points =
            {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.25, 0.25, -0.5}, {0.25, 0.25, 0.5}, {3, 3, 0.25}},
        .triangles = {{0, 1, 2}, {3, 4, 5}}};
    const auto found = find_self_intersections(soup);
    REQUIRE(found.crossings.size() == 1);
    CHECK(found.crossings[0].first == 0);
    CHECK(found.crossings[0].second == 1);
    CHECK(found.crossings[0].position.z() == Approx(0.0).margin(1e-14));
    // Touching in a point that is no common vertex counts too.
    soup.points[3].z() = 0.0;
    CHECK(find_self_intersections(soup).crossings.size() == 1);
    soup.points[3].z() = 1e-300;
    CHECK(find_self_intersections(soup).crossings.empty());
}

TEST_CASE("find_self_intersections: triangles with a common vertex or edge", "[meshing][surface]") {
    const std::vector<Vector3> points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0},  {1, 1, -1},
                                      {1, 1, 1}, {0, 1, 1}, {0.5, 1, 0}};
    const auto count = [&](const std::array<int, 3>& a, const std::array<int, 3>& b) {
        return find_self_intersections({points, {a, b}}).crossings.size();
    };
    // Vertex 0: through the first triangle; beside it.
    CHECK(count({0, 1, 2}, {0, 3, 4}) == 1);
    CHECK(count({0, 1, 2}, {0, 4, 5}) == 0);
    // Edge 0, 2: folded flat onto the first one; its continuation; the same twice.
    CHECK(count({0, 1, 2}, {0, 2, 6}) == 1);
    CHECK(count({0, 1, 2}, {1, 2, 6}) == 0);
    CHECK(count({0, 1, 2}, {2, 1, 0}) == 0);
}

TEST_CASE("find_self_intersections: crossing cubes, the first so many", "[meshing][surface]") {
    const TriangleSoup crossing =
        join(make_cube(3), moved(make_cube(3), 1.0, Vector3(0.55, 0.45, 0.35)));
    const auto all = find_self_intersections(crossing);
    CHECK_FALSE(all.is_cut_short);
    REQUIRE(all.crossings.size() > 20);
    for (const TriangleCrossing& crossing_pair : all.crossings) {
        CHECK(crossing_pair.first < 108);
        CHECK(crossing_pair.second >= 108);
        // On the surface of the common box.
        const Vector3& p = crossing_pair.position;
        CHECK((p.array() >= Vector3(0.55, 0.45, 0.35).array() - 1e-9).all());
        CHECK((p.array() <= 1.0 + 1e-9).all());
    }
    const auto some = find_self_intersections(crossing, 5);
    CHECK(some.is_cut_short);
    REQUIRE(some.crossings.size() == 5);
    CHECK(some.crossings[4].second == all.crossings[4].second);
    CHECK_FALSE(find_self_intersections(crossing, all.crossings.size()).is_cut_short);
    // A smaller cube inside crosses nothing.
    CHECK(find_self_intersections(join(make_cube(3), moved(make_cube(2), 0.5, {0.2, 0.2, 0.2})))
              .crossings.empty());
}

TEST_CASE("find_self_intersections: 100000 triangles take seconds at most", "[meshing][surface]") {
    const TriangleSoup torus = make_torus(320, 160, 2.0, 0.7);
    REQUIRE(torus.triangles.size() > 100000);
    const auto start = std::chrono::steady_clock::now();
    CHECK(find_self_intersections(torus).crossings.empty());
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    // A guard against quadratic work, which would take hours: machines may be busy.
    CHECK(seconds.count() < 60.0);
}

TEST_CASE("find_self_intersections: vertex numbers must exist", "[meshing][surface]") {
    TriangleSoup soup = make_tetrahedron();
    soup.triangles[3][0] = -1;
    CHECK_THROWS_WITH(find_self_intersections(soup), Catch::Contains("triangle 3 has vertices -1"));
}
