#include "meshing/parts/planar_mesh.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <set>

#include "iga/core/error.h"

namespace couture::meshing {

using Catch::Matchers::Contains;

namespace {

/// @param sign  +1: counter-clockwise, -1: clockwise
std::vector<Vector2> polygon(int n, double radius, int sign, const Vector2& centre = {0.0, 0.0}) {
    std::vector<Vector2> points;
    for (int i = 0; i < n; ++i) {
        const double angle = sign * 2 * std::numbers::pi * i / n;
        points.push_back(centre + radius * Vector2(std::cos(angle), std::sin(angle)));
    }
    return points;
}

double area(const PlanarMesh& mesh, const std::array<int, 3>& t) {
    const Vector2 u = mesh.points[t[1]] - mesh.points[t[0]];
    const Vector2 v = mesh.points[t[2]] - mesh.points[t[0]];
    return (u.x() * v.y() - u.y() * v.x()) / 2;
}

double polygon_area(int n, double radius) {
    return n * radius * radius * std::sin(2 * std::numbers::pi / n) / 2;
}

const PlanarSize even = [](const Vector2& /*p*/) { return 0.1; };

}  // namespace

TEST_CASE("planar mesh: triangles cover the region between the loops, counter-clockwise",
          "[parts]") {
    const PlanarMesh mesh = mesh_planar_region(
        {polygon(63, 1.0, 1), polygon(20, 0.3, -1, {0.5, 0.0}), polygon(20, 0.3, -1, {-0.5, 0.0})},
        even);
    double sum = 0.0;
    for (const auto& triangle : mesh.triangles) {
        CHECK(area(mesh, triangle) > 0.0);
        sum += area(mesh, triangle);
    }
    constexpr double rounding = 1e-13;
    CHECK(sum == Approx(polygon_area(63, 1.0) - 2 * polygon_area(20, 0.3)).epsilon(rounding));
}

TEST_CASE("planar mesh: the loops' edges stay, each beside one triangle", "[parts]") {
    const std::vector<std::vector<Vector2>> loops = {polygon(40, 1.0, 1), polygon(9, 0.2, -1)};
    const PlanarMesh mesh = mesh_planar_region(loops, even);
    std::multiset<std::pair<int, int>> edges;
    for (const auto& triangle : mesh.triangles) {
        for (int k = 0; k < 3; ++k) {
            edges.insert({triangle[k], triangle[(k + 1) % 3]});
        }
    }
    int first = 0;
    for (const auto& loop : loops) {
        const int n = static_cast<int>(loop.size());
        for (int i = 0; i < n; ++i) {
            CHECK(mesh.points[first + i] == loop[i]);
            CHECK(edges.count({first + i, first + (i + 1) % n}) == 1);
            CHECK(edges.count({first + (i + 1) % n, first + i}) == 0);
        }
        first += n;
    }
    // chi of a ring is 0: V - E + F with each inner edge twice in `edges`.
    const int n_boundary = 40 + 9;
    const int n_edges = (static_cast<int>(edges.size()) + n_boundary) / 2;
    CHECK(static_cast<int>(mesh.points.size()) - n_edges +
              static_cast<int>(mesh.triangles.size()) ==
          0);
}

TEST_CASE("planar mesh: edges follow the wanted length", "[parts]") {
    const PlanarSize graded = [](const Vector2& p) { return 0.03 + 0.1 * p.norm(); };
    std::vector<Vector2> outer = polygon(48, 1.0, 1);
    const PlanarMesh mesh = mesh_planar_region({outer}, graded);
    double sum = 0.0;
    int n = 0;
    for (const auto& triangle : mesh.triangles) {
        for (int k = 0; k < 3; ++k) {
            const Vector2& a = mesh.points[triangle[k]];
            const Vector2& b = mesh.points[triangle[(k + 1) % 3]];
            const double ratio = (b - a).norm() / graded((a + b) / 2);
            CHECK(ratio > 0.4);
            CHECK(ratio < 1.8);
            sum += ratio;
            ++n;
        }
    }
    CHECK(sum / n == Approx(1.0).margin(0.15));
}

TEST_CASE("planar mesh: errors", "[parts]") {
    const auto mesh = [](std::vector<std::vector<Vector2>> loops) {
        return mesh_planar_region(loops, even);
    };
    CHECK_THROWS_WITH(mesh({{{0.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}, {1.0, 1.0}}}),
                      Contains("mesh_planar_region: the edge from (") &&
                          Contains("crosses another one; loops must be simple"));
    CHECK_THROWS_WITH(mesh({{{0.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}, {1.0, 0.0}}}),
                      Contains("mesh_planar_region: point 3 at (1, 0) stands twice"));
    CHECK_THROWS_WITH(mesh({}), Contains("nothing lies inside 0 loops with 0 points"));
}

}  // namespace couture::meshing
