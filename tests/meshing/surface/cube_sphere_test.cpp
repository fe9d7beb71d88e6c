#include "meshing/surface/cube_sphere.h"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <map>
#include <numbers>

#include "iga/core/error.h"

using namespace couture;
using namespace couture::meshing;

TEST_CASE("make_cube_sphere: a closed oriented sphere of 6 n^2 quads", "[meshing]") {
    const int n = GENERATE(1, 2, 5, 16);
    const QuadMesh sphere = make_cube_sphere(n);
    CHECK(sphere.quads.size() == static_cast<std::size_t>(6 * n * n));
    CHECK(sphere.points.size() == static_cast<std::size_t>(6 * n * n + 2));
    std::map<std::pair<int, int>, int> edges;
    double volume = 0.0;
    for (const auto& quad : sphere.quads) {
        for (int k = 0; k < 4; ++k) ++edges[{quad[k], quad[(k + 1) % 4]}];
        const auto& p = sphere.points;
        volume += p[quad[0]].dot(p[quad[1]].cross(p[quad[2]])) / 6.0 +
                  p[quad[0]].dot(p[quad[2]].cross(p[quad[3]])) / 6.0;
    }
    CHECK(edges.size() == static_cast<std::size_t>(24 * n * n));
    for (const auto& [edge, count] : edges) {
        REQUIRE(count == 1);
        REQUIRE(edges.count({edge.second, edge.first}) == 1);
    }
    for (const Vector3& point : sphere.points) CHECK(point.norm() == Approx(1.0));
    CHECK(volume > 0.0);
    CHECK(volume < 4.0 / 3.0 * std::numbers::pi);
    if (n == 16) CHECK(volume == Approx(4.0 / 3.0 * std::numbers::pi).epsilon(0.02));
}

TEST_CASE("make_cube_sphere: lines of a face are at equal angles", "[meshing]") {
    constexpr int n = 6;
    const QuadMesh sphere = make_cube_sphere(n);
    // On the great circle x = 0 edges are 360 degrees / (4 n) long.
    int n_on_circle = 0;
    for (const auto& quad : sphere.quads) {
        for (int k = 0; k < 4; ++k) {
            const Vector3& a = sphere.points[quad[k]];
            const Vector3& b = sphere.points[quad[(k + 1) % 4]];
            if (std::abs(a.x()) > 1e-12 || std::abs(b.x()) > 1e-12) continue;
            ++n_on_circle;
            CHECK(std::acos(a.dot(b)) == Approx(std::numbers::pi / (2 * n)));
        }
    }
    CHECK(n_on_circle == 2 * 4 * n);
}

TEST_CASE("make_cube_sphere: refuses other numbers", "[meshing]") {
    CHECK_THROWS_AS(make_cube_sphere(0), InputError);
    CHECK_THROWS_AS(make_cube_sphere(1001), InputError);
}
