#include "rom/correlation.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "rom/designs.h"

using namespace couture;
using namespace couture::rom;

TEST_CASE("correlation: closed forms at a distance of one length", "[rom]") {
    CHECK(correlation(CorrelationKind::gaussian, 0.3, 0.3) == Approx(std::exp(-0.5)));
    CHECK(correlation(CorrelationKind::matern_5_2, 0.3, 0.3) ==
          Approx((1.0 + std::sqrt(5.0) + 5.0 / 3.0) * std::exp(-std::sqrt(5.0))));
    CHECK(correlation(CorrelationKind::matern_5_2, 0.0, 0.3) == 1.0);
}

TEST_CASE("correlation: derivatives agree with differences", "[rom]") {
    const auto kind = GENERATE(CorrelationKind::gaussian, CorrelationKind::matern_5_2);
    const double x = GENERATE(-0.7, -0.1, 0.25, 1.4);
    const double length = 0.4;
    const double h = 1e-6;
    const double c = correlation(kind, x, length);
    const double by_length =
        (correlation(kind, x, length * std::exp(h)) - correlation(kind, x, length * std::exp(-h))) /
        (2.0 * h);
    // Of two points, both ways.
    const MatrixX points = (MatrixX(2, 1) << 0.2, 0.2 + x).finished();
    const MatrixX weights = MatrixX::Constant(2, 2, 0.5 * c);
    const VectorX lengths = VectorX::Constant(1, length);
    CHECK(log_length_derivatives(kind, points, lengths, weights)[0] ==
          Approx(by_length).epsilon(1e-6));
    const double by_x =
        (correlation(kind, x + h, length) - correlation(kind, x - h, length)) / (2.0 * h);
    CHECK(c * difference_derivative(kind, x, length) == Approx(by_x).epsilon(1e-6));
}

TEST_CASE("correlations: product over axes", "[rom]") {
    const MatrixX a = random_design(2, 3, 1);
    const MatrixX b = random_design(2, 4, 2);
    const Vector2 lengths(0.2, 0.7);
    const MatrixX K = correlations(CorrelationKind::matern_5_2, a, b, lengths);
    REQUIRE(K.rows() == 3);
    REQUIRE(K.cols() == 4);
    CHECK(K(2, 1) == Approx(correlation(CorrelationKind::matern_5_2, a(2, 0) - b(1, 0), 0.2) *
                            correlation(CorrelationKind::matern_5_2, a(2, 1) - b(1, 1), 0.7)));
}
