#include "iga/spline/bernstein.h"

#include <catch2/catch.hpp>
#include <random>

using namespace couture;
using namespace couture::iga;

namespace {

/// Sums of a few hundred products of numbers of order 1.
constexpr double rounding = 1e-13;

template <int d>
Bernstein<d> random_polynomial(const std::array<int, d>& degrees, unsigned seed) {
    std::mt19937 generator(seed);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    auto result = Bernstein<d>::zero(degrees);
    for (double& c : result.coefficients) {
        c = uniform(generator);
    }
    return result;
}

const std::array<Vector3, 3> points{Vector3(0.1, 0.7, 0.4), Vector3(0.0, 1.0, 0.5),
                                    Vector3(0.93, 0.21, 1.0)};

}  // namespace

TEST_CASE("Bernstein: constants have equal coefficients, coordinates their abscissae", "[spline]") {
    auto constant = Bernstein<3>::zero({2, 3, 1});
    auto second = constant;
    for (std::size_t i = 0; i < constant.coefficients.size(); ++i) {
        constant.coefficients[i] = 2.5;
        second.coefficients[i] = second.abscissa(static_cast<int>(i))[1];
    }
    for (const Vector3& xi : points) {
        CHECK(constant(xi) == Approx(2.5));
        CHECK(second(xi) == Approx(xi[1]).margin(rounding));
        CHECK(second.derivative(1)(xi) == Approx(1.0));
        CHECK(second.derivative(0)(xi) == Approx(0.0).margin(rounding));
    }
}

TEST_CASE("Bernstein: halves are the same polynomial", "[spline]") {
    const auto P = random_polynomial<3>({3, 5, 2}, 1);
    for (int k = 0; k < 3; ++k) {
        const auto [low, high] = P.halves(k);
        for (const Vector3& xi : points) {
            Vector3 at = xi;
            at[k] = 0.5 * xi[k];
            CHECK(low(xi) == Approx(P(at)).margin(rounding));
            at[k] = 0.5 + 0.5 * xi[k];
            CHECK(high(xi) == Approx(P(at)).margin(rounding));
        }
    }
}

TEST_CASE("ScaledBernstein: products are those of the values, up to degree 23", "[spline]") {
    const int degree = GENERATE(1, 2, 5, 8);
    const auto P = random_polynomial<3>({degree, 2, 1}, 2);
    const auto Q = random_polynomial<3>({2 * degree - 1, 1, 3}, 3);
    auto product = ScaledBernstein<3>::zero({3 * degree - 1, 3, 4});
    product.add_product(-2.0, to_scaled(P), to_scaled(Q));
    const Bernstein<3> PQ = to_bernstein(product);
    for (const Vector3& xi : points) {
        CHECK(PQ(xi) == Approx(-2.0 * P(xi) * Q(xi)).margin(rounding));
    }
}
