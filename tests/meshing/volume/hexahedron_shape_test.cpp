#include "meshing/volume/hexahedron_shape.h"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>

namespace couture::meshing {

namespace {

constexpr double rounding = 1e-13;
/// Central differences with steps of 1e-5 of a function of size 1.
constexpr double difference_error = 1e-8;

Hexahedron box(double x, double y, double z) {
    Hexahedron result;
    for (int i = 0; i < 8; ++i) {
        result.col(i) = Vector3((i & 1) * x, (i >> 1 & 1) * y, (i >> 2 & 1) * z);
    }
    return result;
}

Hexahedron disturbed(unsigned seed, double size) {
    std::mt19937 generator(seed);
    std::uniform_real_distribution<double> uniform(-size, size);
    Hexahedron result = box(1.0, 1.0, 1.0);
    for (double& x : result.reshaped()) {
        x += uniform(generator);
    }
    return result;
}

}  // namespace

TEST_CASE("shape_ratio: half diagonal over half thickness of a box", "[volume]") {
    CHECK(iga::shape_ratio(box(1.0, 1.0, 1.0)) == Approx(std::numbers::sqrt3).epsilon(rounding));
    CHECK(iga::shape_ratio(box(1.0, 2.0, 0.5)) ==
          Approx(std::sqrt(1.0 + 4.0 + 0.25) / 0.5).epsilon(rounding));
    CHECK(iga::shape_ratio(box(1.0, 1.0, 0.0)) == std::numeric_limits<double>::infinity());
}

TEST_CASE("shape_ratio: simple shear of a cube", "[volume]") {
    // Half the long diagonal over half the distance of the slanted faces.
    Hexahedron sheared = box(1.0, 1.0, 1.0);
    const double gamma = 1.5;
    sheared.row(0) += gamma * sheared.row(2);
    const double A = 0.5 * std::sqrt((1.0 + gamma) * (1.0 + gamma) + 2.0);
    const double B = 0.5 / std::sqrt(1.0 + gamma * gamma);
    CHECK(iga::shape_ratio(sheared) == Approx(A / B).epsilon(rounding));
}

TEST_CASE("shape ratios: do not depend on position, size, rotation", "[volume]") {
    const Hexahedron hexahedron = disturbed(3, 0.2);
    const Matrix<3> rotation = Eigen::AngleAxisd(0.7, Vector3(1, 2, 3).normalized()).matrix();
    const Hexahedron other = (5.0 * rotation * hexahedron).colwise() + Vector3(3.0, -1.0, 0.5);
    CHECK(iga::shape_ratio(other) == Approx(iga::shape_ratio(hexahedron)).epsilon(rounding));
    CHECK(smooth_shape_ratio(other, 1).value ==
          Approx(smooth_shape_ratio(hexahedron, 1).value).epsilon(rounding));
}

TEST_CASE("smooth_shape_ratio: 1 for a cube, never above the exact one", "[volume]") {
    CHECK(smooth_shape_ratio(box(2.0, 2.0, 2.0), 1).value == Approx(1.0).epsilon(rounding));
    for (unsigned seed = 0; seed < 20; ++seed) {
        const Hexahedron hexahedron = disturbed(seed, 0.25);
        CHECK(std::numbers::sqrt3 * smooth_shape_ratio(hexahedron, 1).value <=
              iga::shape_ratio(hexahedron) * (1.0 + rounding));
    }
}

TEST_CASE("smooth_shape_ratio: infinite for the wrong hand", "[volume]") {
    CHECK(std::isinf(smooth_shape_ratio(box(1.0, 1.0, 1.0), -1).value));
    CHECK(std::isinf(smooth_shape_ratio(box(1.0, 1.0, -1.0), 1).value));
    CHECK(smooth_shape_ratio(box(1.0, 1.0, -1.0), -1).value == Approx(1.0));
}

TEST_CASE("smooth_shape_ratio: gradient by differences", "[volume]") {
    constexpr double step = 1e-5;
    for (unsigned seed = 0; seed < 5; ++seed) {
        const Hexahedron x = disturbed(seed, 0.25);
        const Hexahedron gradient = smooth_shape_ratio(x, 1).gradient;
        for (int i = 0; i < 24; ++i) {
            Hexahedron above = x;
            Hexahedron below = x;
            above.reshaped()[i] += step;
            below.reshaped()[i] -= step;
            const double difference =
                (smooth_shape_ratio(above, 1).value - smooth_shape_ratio(below, 1).value) /
                (2.0 * step);
            CHECK(gradient.reshaped()[i] == Approx(difference).margin(difference_error));
        }
    }
}

}  // namespace couture::meshing
