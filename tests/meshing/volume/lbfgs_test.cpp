#include "meshing/volume/lbfgs.h"

#include <catch2/catch.hpp>

namespace couture::meshing {

namespace {

constexpr double rounding = 1e-9;

}  // namespace

TEST_CASE("Lbfgs: minus the gradient before the first step", "[volume]") {
    const VectorX gradient = VectorX::LinSpaced(4, -1.0, 2.0);
    CHECK(Lbfgs().direction(gradient) == -gradient);
}

TEST_CASE("Lbfgs: exact steps end on a quadratic after as many as there are unknowns", "[volume]") {
    const VectorX curvature = VectorX::LinSpaced(6, 1.0, 30.0);
    VectorX x = VectorX::LinSpaced(6, 1.0, -3.0);
    Lbfgs memory;
    for (int i = 0; i < 6; ++i) {
        const VectorX gradient = curvature.cwiseProduct(x);
        const VectorX direction = memory.direction(gradient);
        const double length =
            -gradient.dot(direction) / direction.dot(curvature.cwiseProduct(direction));
        const VectorX step = length * direction;
        memory.add(step, curvature.cwiseProduct(step));
        x += step;
    }
    CHECK(x.norm() < rounding);
}

TEST_CASE("Lbfgs: steps without positive curvature are left out", "[volume]") {
    Lbfgs memory;
    memory.add(Vector2(1.0, 0.0), Vector2(-1.0, 0.0));
    CHECK(memory.is_empty());
    memory.add(Vector2(1.0, 0.0), Vector2(1.0, 0.0));
    CHECK_FALSE(memory.is_empty());
    memory.clear();
    CHECK(memory.is_empty());
}

}  // namespace couture::meshing
