#include "rom/designs.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <set>
#include <vector>

#include "iga/core/error.h"

using namespace couture;
using namespace couture::rom;

namespace {

std::set<std::vector<double>> as_set(const MatrixX& points) {
    std::set<std::vector<double>> set;
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
        const VectorX row = points.row(i).transpose();
        set.emplace(row.data(), row.data() + row.size());
    }
    return set;
}

double least_distance(const MatrixX& points) {
    double least = 1e9;
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
        for (Eigen::Index j = 0; j < i; ++j) {
            least = std::min(least, (points.row(i) - points.row(j)).norm());
        }
    }
    return least;
}

/// Star discrepancy in two dimensions, at corners between points.
double discrepancy(const MatrixX& points) {
    double worst = 0.0;
    const auto n = static_cast<double>(points.rows());
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
        for (Eigen::Index j = 0; j < points.rows(); ++j) {
            const double x = points(i, 0);
            const double y = points(j, 1);
            const auto inside = static_cast<double>(
                ((points.col(0).array() <= x) && (points.col(1).array() <= y)).count());
            worst = std::max(worst, std::abs(inside / n - x * y));
        }
    }
    return worst;
}

}  // namespace

TEST_CASE("star_design: counts of the reference text", "[rom]") {
    CHECK(star_design(9, 2).rows() == 37);
    CHECK(star_design(6, 2).rows() == 25);
    CHECK(star_design(9, 1).rows() == 19);
    CHECK_THROWS_AS(star_design(3, 3), InputError);
}

TEST_CASE("star_design: the centre first, then one axis at a time", "[rom]") {
    const MatrixX points = star_design(3, 2);
    CHECK((points.row(0).array() == 0.5).all());
    for (Eigen::Index i = 1; i < points.rows(); ++i) {
        CHECK((points.row(i).array() != 0.5).count() == 1);
    }
    CHECK(as_set(points).size() == 13);
}

TEST_CASE("smolyak_design: contains the star with the equidistant rule only", "[rom]") {
    const auto star = as_set(star_design(4, 2));
    const auto grid = as_set(smolyak_design(4, 2, NestedRule::equidistant));
    CHECK(std::includes(grid.begin(), grid.end(), star.begin(), star.end()));
    const auto other = as_set(smolyak_design(4, 2, NestedRule::clenshaw_curtis));
    CHECK_FALSE(std::includes(other.begin(), other.end(), star.begin(), star.end()));
    CHECK(other.size() == grid.size());
}

TEST_CASE("smolyak_design: known numbers of points, each once", "[rom]") {
    // Of Clenshaw-Curtis grids: d = 2: 1, 5, 13, 29; d = 10, level 2: 221.
    const std::vector<int> counts = {1, 5, 13, 29};
    for (int level = 0; level < 4; ++level) {
        const MatrixX points = smolyak_design(2, level, NestedRule::clenshaw_curtis);
        CHECK(points.rows() == counts[level]);
        CHECK(static_cast<int>(as_set(points).size()) == counts[level]);
        CHECK((points.row(0).array() == 0.5).all());
    }
    CHECK(smolyak_design(10, 2, NestedRule::equidistant).rows() == 221);
}

TEST_CASE("full_design: all combinations, the last axis fastest", "[rom]") {
    const MatrixX points = full_design(2, 3);
    REQUIRE(points.rows() == 9);
    CHECK(points(1, 0) == 0.0);
    CHECK(points(1, 1) == 0.5);
    CHECK(points(8, 0) == 1.0);
    CHECK(full_design(3, 1)(0, 2) == 0.5);
    CHECK_THROWS_AS(full_design(20, 10), InputError);
}

TEST_CASE("latin_hypercube_design: one point in each part of each axis", "[rom]") {
    const int n = 40;
    const MatrixX points = latin_hypercube_design(5, n, 3);
    for (Eigen::Index axis = 0; axis < 5; ++axis) {
        std::set<int> parts;
        for (int i = 0; i < n; ++i) {
            parts.insert(static_cast<int>(points(i, axis) * n));
        }
        CHECK(static_cast<int>(parts.size()) == n);
    }
    CHECK(points == latin_hypercube_design(5, n, 3));
    CHECK_FALSE(points == latin_hypercube_design(5, n, 4));
}

TEST_CASE("latin_hypercube_design: points are farther apart than random ones", "[rom]") {
    const double random = least_distance(random_design(3, 60, 1));
    CHECK(least_distance(latin_hypercube_design(3, 60, 1)) > 3.0 * random);
    CHECK(least_distance(latin_hypercube_design(3, 60, 1)) > 0.14);
}

TEST_CASE("sobol_design: fills the square more evenly than random points", "[rom]") {
    CHECK(discrepancy(sobol_design(2, 128)) < 0.5 * discrepancy(random_design(2, 128, 1)));
    const MatrixX points = sobol_design(9, 100);
    CHECK(points.minCoeff() >= 0.0);
    CHECK(points.maxCoeff() < 1.0);
}

TEST_CASE("designs: refuse to be empty", "[rom]") {
    CHECK_THROWS_AS(random_design(0, 4, 1), InputError);
    CHECK_THROWS_AS(sobol_design(3, 0), InputError);
    CHECK_THROWS_AS(latin_hypercube_design(3, 0, 1), InputError);
    CHECK_THROWS_AS(smolyak_design(3, -1, NestedRule::equidistant), InputError);
}
