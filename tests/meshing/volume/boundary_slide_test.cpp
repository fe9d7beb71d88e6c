#include "meshing/volume/boundary_slide.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/meshing/volume/volume_samples.h"

namespace couture::meshing {

using iga::MultiPatch;

namespace {

constexpr double rounding = 1e-12;

/// Turns a cylinder about its axis by an angle that varies along it.
Vector3 twisted(const Vector3& x) {
    const double angle = 0.2 * std::sin(2.0 * x[2]);
    return {std::cos(angle) * x[0] - std::sin(angle) * x[1],
            std::sin(angle) * x[0] + std::cos(angle) * x[1], x[2]};
}

}  // namespace

TEST_CASE("BoundarySlide: a boundary that has not moved is not changed", "[volume]") {
    for (const int degree : {1, 2, 3}) {
        const MultiPatch<3> part = part_of("cylinder_o_grid", degree, 3);
        const BoundaryFeatures features(part);
        const BoundarySlide slide(part, features);
        const MatrixX points = points_of(part, features.dofs());
        CHECK(slide.has_curved());
        CHECK((slide.retracted(points) - points).cwiseAbs().maxCoeff() < rounding);
        CHECK(slide.distance(points, 2) < rounding);
    }
}

TEST_CASE("BoundarySlide: frames take out what leaves faces and curves", "[volume]") {
    const MultiPatch<3> part = part_of("cylinder_o_grid", 2, 3);
    const BoundaryFeatures features(part);
    const BoundarySlide slide(part, features);
    const MatrixX points = points_of(part, features.dofs());
    MatrixX rates = MatrixX::Ones(3, points.cols());
    slide.frames(points).project(rates);
    for (int i = 0; i < points.cols(); ++i) {
        const Vector3 radial(points(0, i), points(1, i), 0.0);
        if (features.freedom(i) == Freedom::curve) {
            CHECK(std::abs(rates(2, i)) < rounding);
            CHECK(std::abs(rates.col(i).dot(radial.normalized())) < 0.1);
        } else if (features.freedom(i) == Freedom::face && !slide.is_curved(i)) {
            CHECK(std::abs(rates(2, i)) < rounding);
            CHECK(rates(0, i) == Approx(1.0));
        }
    }
}

TEST_CASE("BoundarySlide: points cross patch edges, and the distance falls with h^2 or faster",
          "[volume]") {
    // Radii of a cylinder whose wall was turned across the seams of its four patches.
    for (const int degree : {1, 2, 3}) {
        std::vector<double> errors;
        for (const int n : {4, 8}) {
            const MultiPatch<3> part = part_of("cylinder_o_grid", degree, n);
            const BoundaryFeatures features(part);
            const BoundarySlide slide(part, features);
            const MatrixX turned = points_of(moved(part, twisted), features.dofs());
            const MatrixX back = slide.retracted(turned);
            errors.push_back(slide.distance(back, 3));
            CHECK(back.allFinite());
        }
        CAPTURE(degree, errors[0], errors[1]);
        CHECK(errors[1] < errors[0] / 3.0);
        CHECK(errors[1] < 2e-2);
    }
}

TEST_CASE("BoundarySlide: without curved faces nothing is put back", "[volume]") {
    const MultiPatch<3> cube = two_patch_cube(2, 4);
    const BoundaryFeatures features(cube);
    const BoundarySlide slide(cube, features);
    const MatrixX points = points_of(cube, features.dofs());
    CHECK_FALSE(slide.has_curved());
    CHECK(slide.retracted(2.0 * points) == 2.0 * points);
}

}  // namespace couture::meshing
