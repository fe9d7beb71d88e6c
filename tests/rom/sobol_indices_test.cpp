#include "rom/sobol_indices.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "iga/core/error.h"

using namespace couture;
using namespace couture::rom;
using Catch::Contains;

namespace {

constexpr double pi = std::numbers::pi;
constexpr double a = 7.0;
constexpr double b = 0.1;

/// Ishigami's function on [-pi, pi]^3, and one that only adds: 3 x_1 + 4 x_2 + 0 x_3.
MatrixX functions(const MatrixX& points) {
    MatrixX values(points.rows(), 2);
    for (Eigen::Index r = 0; r < points.rows(); ++r) {
        const VectorX x = (points.row(r).transpose().array() - 0.5) * 2.0 * pi;
        values(r, 0) = std::sin(x[0]) + a * std::pow(std::sin(x[1]), 2) +
                       b * std::pow(x[2], 4) * std::sin(x[0]);
        values(r, 1) = 3.0 * points(r, 0) + 4.0 * points(r, 1);
    }
    return values;
}

}  // namespace

TEST_CASE("sobol_indices: Ishigami's function", "[rom]") {
    // Variances of the terms, by integration.
    const double pi4 = std::pow(pi, 4);
    const double V1 = 0.5 * std::pow(1.0 + b * pi4 / 5.0, 2);
    const double V2 = a * a / 8.0;
    const double V13 = b * b * pi4 * pi4 * 8.0 / 225.0;
    const double V = V1 + V2 + V13;
    const SobolIndices found = sobol_indices(3, functions, {.n_samples = 8192})[0];
    constexpr double tolerance = 0.01;
    CHECK(found.mean == Approx(a / 2.0).margin(tolerance));
    CHECK(found.variance == Approx(V).epsilon(tolerance));
    const double first[] = {V1 / V, V2 / V, 0.0};
    const double total[] = {(V1 + V13) / V, V2 / V, V13 / V};
    for (int i = 0; i < 3; ++i) {
        CAPTURE(i);
        CHECK(found.first[i].value == Approx(first[i]).margin(tolerance));
        CHECK(found.total[i].value == Approx(total[i]).margin(tolerance));
        CHECK(found.first[i].low <= first[i]);
        CHECK(found.first[i].high >= first[i]);
        CHECK(found.total[i].low <= total[i]);
        CHECK(found.total[i].high >= total[i]);
        CHECK(found.first[i].high - found.first[i].low < 0.1);
    }
}

TEST_CASE("sobol_indices: of a sum first and total are the same", "[rom]") {
    const SobolIndices found = sobol_indices(3, functions)[1];
    const double expected[] = {9.0 / 25.0, 16.0 / 25.0, 0.0};
    for (int i = 0; i < 3; ++i) {
        CHECK(found.first[i].value == Approx(expected[i]).margin(5e-3));
        CHECK(found.total[i].value == Approx(expected[i]).margin(5e-3));
    }
    // An input without effect has a total index of exactly 0.
    CHECK(found.total[2].value == 0.0);
    CHECK(found.total[2].high == 0.0);
}

TEST_CASE("sobol_indices: more samples come nearer, intervals shrink", "[rom]") {
    const SobolIndices few = sobol_indices(3, functions, {.n_samples = 256})[0];
    const SobolIndices many = sobol_indices(3, functions, {.n_samples = 4096})[0];
    for (int i = 0; i < 2; ++i) {
        CHECK(many.total[i].high - many.total[i].low <
              0.5 * (few.total[i].high - few.total[i].low));
    }
}

TEST_CASE("sobol_indices: constants have none, what does not fit is refused", "[rom]") {
    const auto constant = [](const MatrixX& points) {
        return MatrixX(MatrixX::Constant(points.rows(), 1, 3.0));
    };
    const SobolIndices none = sobol_indices(2, constant)[0];
    CHECK(none.variance == 0.0);
    CHECK(none.first[0].value == 0.0);
    CHECK(none.total[1].high == 0.0);
    CHECK_THROWS_WITH(sobol_indices(0, constant), Contains("0 inputs"));
    CHECK_THROWS_WITH(sobol_indices(2, constant, {.n_samples = 1}), Contains("1 samples"));
    CHECK_THROWS_WITH(sobol_indices(2, [](const MatrixX&) { return MatrixX(MatrixX::Zero(1, 1)); }),
                      Contains("1 values of functions at 1024 points"));
}
