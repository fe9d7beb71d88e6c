#include "meshing/surface/polygon_triangles.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>

#include <Eigen/Geometry>

#include "iga/core/error.h"

using namespace couture;
using namespace couture::meshing;

namespace {

using Triangles = std::vector<std::array<int, 3>>;

Triangles split(const std::vector<Vector3>& points) {
    std::vector<int> polygon(points.size());
    std::iota(polygon.begin(), polygon.end(), 0);
    return split_polygon(points, polygon);
}

}  // namespace

TEST_CASE("split_polygon: quads are split along the shorter diagonal that lies inside",
          "[meshing][surface]") {
    CHECK(split({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}) == Triangles{{0, 1, 2}, {0, 2, 3}});
    CHECK(split({{0, 0, 0}, {2, 0, 0}, {3, 1, 0}, {1, 1, 0}}) == Triangles{{0, 1, 3}, {1, 2, 3}});
    // An arrow head: the longer diagonal.
    CHECK(split({{0, 0, 0}, {4, 4, 0}, {0, 1, 0}, {-4, 4, 0}}) == Triangles{{0, 1, 2}, {0, 2, 3}});
    CHECK(split({{4, 4, 0}, {0, 3.9, 0}, {-4, 4, 0}, {0, -9, 0}}) ==
          Triangles{{0, 1, 3}, {1, 2, 3}});
}

TEST_CASE("split_polygon: triangles of a polygon with bays have its area and turn",
          "[meshing][surface]") {
    // A comb, turned in space.
    std::vector<Vector3> comb{{0, 0, 0}, {7, 0, 0}};
    for (int tooth = 3; tooth >= 0; --tooth) {
        comb.emplace_back(2.0 * tooth + 1.0, 3, 0);
        comb.emplace_back(2.0 * tooth, 3, 0);
        if (tooth > 0) {
            comb.emplace_back(2.0 * tooth, 1, 0);
            comb.emplace_back(2.0 * tooth - 1.0, 1, 0);
        }
    }
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(0.7, Vector3(1, 2, 3).normalized()).toRotationMatrix();
    for (Vector3& point : comb) point = turn * point;
    const Vector3 normal = turn * Vector3(0, 0, 1);
    const Triangles triangles = split(comb);
    REQUIRE(triangles.size() == comb.size() - 2);
    double area = 0.0;
    for (const auto& [a, b, c] : triangles) {
        const double part = 0.5 * (comb[b] - comb[a]).cross(comb[c] - comb[a]).dot(normal);
        CHECK(part > -1e-12);
        area += part;
    }
    CHECK(area == Approx(7.0 + 4.0 * 2.0));
}

TEST_CASE("split_polygon: what is no simple polygon still becomes triangles, in no time",
          "[meshing][surface]") {
    CHECK(split({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}}).size() == 3);
    std::vector<Vector3> star;
    for (int i = 0; i < 3000; ++i) star.emplace_back(std::cos(1.9 * i), std::sin(1.9 * i), 0.0);
    CHECK(split(star).size() == 2998);
    CHECK_THROWS_WITH(split({{0, 0, 0}, {1, 0, 0}}),
                      "split_polygon: a polygon with 2 corners; from 3 to 10000 can be split");
    CHECK_THROWS_AS(split(std::vector<Vector3>(10001, Vector3::Zero())), InputError);
}
