#include "meshing/surface/point_grid.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "iga/core/error.h"

using namespace couture;
using namespace couture::meshing;

TEST_CASE("PointGrid: distances are those of looking at all points", "[surface]") {
    constexpr double cell = 0.3;
    std::mt19937 random(5);
    std::uniform_real_distribution<double> coordinate(-1.0, 1.0);
    const auto any_point = [&] {
        return Vector3(coordinate(random), coordinate(random), coordinate(random));
    };
    PointGrid grid(cell);
    std::vector<Vector3> points;
    int n_far = 0;
    for (int trial = 0; trial < 500; ++trial) {
        const Vector3 x = any_point();
        double nearest = cell;
        for (const Vector3& point : points) nearest = std::min(nearest, (point - x).norm());
        // Other roundings where the compiler joins products and sums.
        CHECK(std::abs(grid.distance(x) - nearest) < 1e-15);
        n_far += nearest == cell ? 1 : 0;
        points.push_back(any_point());
        grid.add(points.back());
    }
    CHECK(n_far > 10);
    CHECK(n_far < 490);
}

TEST_CASE("PointGrid: cells without size are refused", "[surface]") {
    CHECK_THROWS_WITH(PointGrid(0.0), "PointGrid: cells of length 0; it must be positive");
}
