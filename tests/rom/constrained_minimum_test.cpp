#include "rom/constrained_minimum.h"

#include <catch2/catch.hpp>
#include <limits>

#include "iga/core/error.h"

using namespace couture;
using namespace couture::rom;

namespace {

constexpr double tolerance = 1e-8;

/// Smallest distance from (2, 1) in the unit disc below the line y = x.
VectorX disc_and_line(const VectorX& x, MatrixX& gradients) {
    gradients.resize(2, 3);
    gradients.col(0) = 2.0 * (x - Vector2(2.0, 1.0));
    gradients.col(1) = 2.0 * x;
    gradients.col(2) = Vector2(-1.0, 1.0);
    return Vector3((x - Vector2(2.0, 1.0)).squaredNorm(), x.squaredNorm() - 1.0, x[1] - x[0]);
}

/// The same below y = x - 2: the disc does not reach that line.
VectorX apart(const VectorX& x, MatrixX& gradients) {
    VectorX values = disc_and_line(x, gradients);
    values[2] += 2.0;
    return values;
}

}  // namespace

TEST_CASE("constrained_minimum: the nearest point of a disc", "[rom]") {
    for (const Vector2& start : {Vector2(0.0, 0.0), Vector2(-1.0, 1.0), Vector2(3.0, 3.0)}) {
        const auto found = constrained_minimum(disc_and_line, start, Vector2(-2.0, -2.0),
                                               Vector2(2.0, 2.0), tolerance);
        CHECK((found.x - Vector2(2.0, 1.0) / std::sqrt(5.0)).norm() < 1e-6);
        CHECK(found.violation <= tolerance);
        CHECK(found.n_evaluations > 1);
    }
}

TEST_CASE("constrained_minimum: bounds hold", "[rom]") {
    // With y <= 0 the nearest point is (1, 0).
    const auto found = constrained_minimum(disc_and_line, Vector2(0.0, 0.0), Vector2(-2.0, -2.0),
                                           Vector2(2.0, 0.0), tolerance);
    CHECK((found.x - Vector2(1.0, 0.0)).norm() < 1e-6);
}

TEST_CASE("constrained_minimum: a problem without a feasible point leaves a violation", "[rom]") {
    const auto found = constrained_minimum(apart, Vector2(0.0, 0.0), Vector2(-2.0, -2.0),
                                           Vector2(2.0, 2.0), tolerance);
    CHECK(found.violation > 0.1);
    CHECK(found.violation < 2.0);
}

TEST_CASE("constrained_minimum: refuses functions that are not finite at the start", "[rom]") {
    const auto bad = [](const VectorX&, MatrixX& gradients) {
        gradients.setZero(1, 1);
        return VectorX(VectorX::Constant(1, std::numeric_limits<double>::quiet_NaN()));
    };
    const VectorX zero = VectorX::Zero(1);
    CHECK_THROWS_AS(constrained_minimum(bad, zero, zero, VectorX::Ones(1), tolerance), SolverError);
}
