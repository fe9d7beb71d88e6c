#include "iga/spline/gauss.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "iga/core/error.h"

using namespace couture;
using namespace couture::iga;

namespace {

// Rounding of a sum of 64 terms.
constexpr double rounding = 1e-15;

double integral_of_power(const GaussRule& rule, int power) {
    double sum = 0.0;
    for (std::size_t i = 0; i < rule.points.size(); ++i) {
        sum += rule.weights[i] * std::pow(rule.points[i], power);
    }
    return sum;
}

}  // namespace

TEST_CASE("gauss_rule: n points integrate degree 2 n - 1 exactly", "[spline]") {
    for (int n = 1; n <= max_gauss_points; ++n) {
        for (int power = 0; power <= 2 * n - 1; ++power) {
            CHECK(std::abs(integral_of_power(gauss_rule(n), power) - 1.0 / (power + 1)) < rounding);
        }
    }
}

TEST_CASE("gauss_rule: degree 2 n is not exact, by the known remainder", "[spline]") {
    double remainder = 1.0 / 12.0;  // (n!)^4 / ((2n + 1) ((2n)!)^2) for n = 1
    for (int n = 1; n <= 8; ++n) {
        const double error = 1.0 / (2 * n + 1) - integral_of_power(gauss_rule(n), 2 * n);
        CHECK(std::abs(error - remainder) < rounding);
        const double m = n + 1;
        remainder *= m * m * m * m * (2 * n + 1) / ((2 * n + 3) * std::pow(2 * m * (2 * m - 1), 2));
    }
}

TEST_CASE("gauss_rule: points lie inside, increase and mirror", "[spline]") {
    for (int n = 1; n <= max_gauss_points; ++n) {
        const GaussRule& rule = gauss_rule(n);
        REQUIRE(rule.points.size() == static_cast<std::size_t>(n));
        CHECK(rule.points.front() > 0.0);
        CHECK(rule.points.back() < 1.0);
        for (int i = 0; i < n; ++i) {
            CHECK(rule.weights[i] > 0.0);
            CHECK(std::abs(rule.points[i] + rule.points[n - 1 - i] - 1.0) < rounding);
            if (i > 0) {
                CHECK(rule.points[i] > rule.points[i - 1]);
            }
        }
    }
}

TEST_CASE("gauss_rule: counts that do not exist are refused", "[spline]") {
    CHECK_THROWS_WITH(gauss_rule(0), "gauss_rule: 0 points; must be from 1 to 64");
    CHECK_THROWS_WITH(gauss_rule(65), "gauss_rule: 65 points; must be from 1 to 64");
}
