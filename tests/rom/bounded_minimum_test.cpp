#include "rom/bounded_minimum.h"

#include <catch2/catch.hpp>
#include <limits>

#include "iga/core/error.h"

using namespace couture;
using namespace couture::rom;

namespace {

double rosenbrock(const VectorX& x, VectorX& gradient) {
    const double a = 1.0 - x[0];
    const double b = x[1] - x[0] * x[0];
    gradient = Vector2(-2.0 * a - 400.0 * x[0] * b, 200.0 * b);
    return a * a + 100.0 * b * b;
}

}  // namespace

TEST_CASE("bounded_minimum: Rosenbrock's valley", "[rom]") {
    const auto found = bounded_minimum(rosenbrock, Vector2(-1.2, 1.0), Vector2(-2.0, -2.0),
                                       Vector2(2.0, 2.0), 1e-12);
    CHECK((found.x - Vector2(1.0, 1.0)).norm() < 1e-3);
}

TEST_CASE("bounded_minimum: stays within bounds, on them if the minimum is outside", "[rom]") {
    // With x <= 0.5 the minimum is (0.5, 0.25).
    const auto found = bounded_minimum(rosenbrock, Vector2(7.0, 7.0), Vector2(-2.0, -2.0),
                                       Vector2(0.5, 2.0), 1e-12);
    CHECK((found.x - Vector2(0.5, 0.25)).norm() < 1e-4);
    CHECK(found.value == Approx(0.25));
}

TEST_CASE("bounded_minimum: refuses a function that is not finite at the start", "[rom]") {
    const auto bad = [](const VectorX&, VectorX& gradient) {
        gradient.setZero();
        return std::numeric_limits<double>::infinity();
    };
    const VectorX zero = VectorX::Zero(1);
    CHECK_THROWS_AS(bounded_minimum(bad, zero, zero, VectorX::Ones(1), 1e-12), SolverError);
}
