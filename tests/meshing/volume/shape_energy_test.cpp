#include "meshing/volume/shape_energy.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "iga/core/parallel.h"
#include "meshing/volume/hexahedron_shape.h"
#include "tests/meshing/volume/volume_samples.h"

namespace couture::meshing {

using iga::MultiPatch;

namespace {

constexpr double rounding = 1e-12;
/// Central differences with steps of 1e-6, relative to the largest derivative.
constexpr double difference_error = 1e-6;

struct Case {
    MultiPatch<3> volume;
    BoundaryFeatures features;
    ShapeEnergy energy;
    MatrixX points;

    explicit Case(MultiPatch<3> start)
        : volume(std::move(start)),
          features(volume),
          energy(volume, features.dofs(), std::vector<int>(volume.n_patches(), 1)),
          points(points_of(volume, features.dofs())) {}
};

MatrixX noise(int n, double size) {
    std::mt19937 generator(5);
    std::uniform_real_distribution<double> uniform(-size, size);
    MatrixX result(3, n);
    for (double& x : result.reshaped()) {
        x = uniform(generator);
    }
    return result;
}

void check_gradient(const Case& c, const MatrixX& points, const ShapeMeasure& measure) {
    constexpr double step = 1e-6;
    const EnergyGradient found = c.energy.with_gradient(points, measure);
    CHECK(found.value == c.energy.value(points, measure));
    const double largest = found.gradient.cwiseAbs().maxCoeff();
    for (int i = 0; i < points.size(); i += 7) {
        MatrixX above = points;
        MatrixX below = points;
        above.reshaped()[i] += step;
        below.reshaped()[i] -= step;
        const double difference =
            (c.energy.value(above, measure) - c.energy.value(below, measure)) / (2.0 * step);
        CHECK(std::abs(found.gradient.reshaped()[i] - difference) < difference_error * largest);
    }
}

}  // namespace

TEST_CASE("ShapeEnergy: 1 + weight for cubes of any size", "[volume]") {
    for (const int degree : {1, 2, 3}) {
        const Case c(cube_of(degree, 3));
        CHECK(c.energy.value(c.points, {.power = 3}) == Approx(1.0).epsilon(rounding));
        CHECK(c.energy.value(7.0 * c.points, {.power = 3, .shape_ratio_weight = 0.5}) ==
              Approx(1.5).epsilon(rounding));
    }
}

TEST_CASE("ShapeEnergy: mean ratio of stretched and sheared boxes in closed form", "[volume]") {
    // |J|^3 / (3 sqrt(3) det J) of diag(1, 2, 4) and of [1 0 g; 0 1 0; 0 0 1].
    const double gamma = 1.3;
    const MultiPatch<3> stretched =
        moved(cube_of(2, 2), [](const Vector3& x) { return Vector3(x[0], 2 * x[1], 4 * x[2]); });
    const MultiPatch<3> sheared = moved(
        cube_of(2, 2), [&](const Vector3& x) { return Vector3(x[0] + gamma * x[2], x[1], x[2]); });
    const Case a(stretched);
    const Case b(sheared);
    CHECK(a.energy.value(a.points, {.power = 1}) ==
          Approx(std::pow(21.0 / 3.0, 1.5) / 8.0).epsilon(rounding));
    CHECK(b.energy.value(b.points, {.power = 2}) ==
          Approx(std::pow((3.0 + gamma * gamma) / 3.0, 3.0)).epsilon(rounding));
    CHECK(b.energy.summary(b.points).min_scaled_jacobian ==
          Approx(1.0 / std::sqrt(1.0 + gamma * gamma)).epsilon(rounding));
}

TEST_CASE("ShapeEnergy: gradient by differences", "[volume]") {
    const ShapeMeasure measure{.power = 3, .shape_ratio_weight = 0.7};
    for (const int degree : {1, 2, 3}) {
        const Case c(cube_of(degree, 3));
        check_gradient(c, c.points + noise(c.features.dofs().n_dofs, 0.03), measure);
    }
    const Case rational(part_of("cylinder_o_grid", 2, 2));
    check_gradient(rational, rational.points + noise(rational.features.dofs().n_dofs, 0.01),
                   measure);
    const Case cubic(part_of("thick_cylinder_3d", 3, 2));
    check_gradient(cubic, cubic.points + noise(cubic.features.dofs().n_dofs, 0.01), measure);
}

TEST_CASE("ShapeEnergy: regularised, it is finite and smooth where elements fold", "[volume]") {
    const Case c(cube_of(1, 3));
    const MatrixX folded = c.points + noise(c.features.dofs().n_dofs, 0.3);
    CHECK(c.energy.summary(folded).min_inverse_mean_ratio < 0.0);
    CHECK(std::isinf(c.energy.value(folded, {.power = 1})));
    check_gradient(c, folded, {.power = 1, .regularization = 0.3});
    check_gradient(c, folded, {.power = 1, .regularization = 0.3, .size_weight = 0.2});
}

TEST_CASE("ShapeEnergy: the part of sizes is that of the change of volume", "[volume]") {
    // (s^3 + s^-3) / 2 beside 1, for cubes scaled by s.
    const Case c(cube_of(2, 2));
    for (const double s : {0.5, 1.0, 3.0}) {
        const double d = s * s * s;
        CHECK(c.energy.value(s * c.points, {.power = 2, .size_weight = 0.3}) ==
              Approx(1.0 + 0.3 * 0.5 * (d + 1.0 / d)).epsilon(rounding));
    }
}

TEST_CASE("ShapeEnergy: dense samples see folds on an edge, between the others", "[volume]") {
    // One element of degree 3; the control points next to the edge x = y = 0 lie so that det J is
    // z-dependent there: 1 at the ends, negative in between, positive at all Gauss points.
    Case c(cube_of(3, 1));
    MatrixX points = c.points;
    for (int i = 0; i < points.cols(); ++i) {
        const Vector3 x = points.col(i);
        const bool is_next = std::abs(x[0] - 1.0 / 3.0) < 1e-9 && std::abs(x[1]) < 1e-9;
        if (is_next && x[2] > 0.1 && x[2] < 0.9) points(0, i) = -0.2;
    }
    CHECK(c.energy.summary(points).min_scaled_jacobian > 0.0);
    CHECK(c.energy.sample_densely(0, {0}));
    CHECK_FALSE(c.energy.sample_densely(0, {0}));
    CHECK(c.energy.summary(points).min_scaled_jacobian < 0.0);
    check_gradient(c, c.points + noise(c.features.dofs().n_dofs, 0.01),
                   {.power = 3, .shape_ratio_weight = 0.7});
}

TEST_CASE("ShapeEnergy: the summary names the worst place", "[volume]") {
    Case c(two_patch_cube(1, 4));
    // The corner (1, 1, 1) pushed in through the opposite corner of its element.
    int corner = 0;
    c.points.colwise().sum().maxCoeff(&corner);
    c.points.col(corner) -= Vector3::Constant(0.27);
    const ShapeSummary summary = c.energy.summary(c.points);
    CHECK(summary.min_inverse_mean_ratio < 0.0);
    CHECK(summary.patch == 1);
    CHECK(summary.xi.minCoeff() >= 0.5);
}

TEST_CASE("ShapeEnergy: bit-identical for 1 and 2 threads", "[volume]") {
    const Case c(cube_of(2, 4));
    const MatrixX points = c.points + noise(c.features.dofs().n_dofs, 0.03);
    const int threads = n_threads();
    set_n_threads(1);
    const EnergyGradient one = c.energy.with_gradient(points, {});
    set_n_threads(2);
    const EnergyGradient two = c.energy.with_gradient(points, {});
    set_n_threads(threads);
    CHECK(one.value == two.value);
    CHECK(one.gradient == two.gradient);
}

TEST_CASE("ShapeEnergy: left-handed patches count as what they are", "[volume]") {
    const MultiPatch<3> mirrored =
        moved(cube_of(2, 2), [](const Vector3& x) { return Vector3(-x[0], x[1], x[2]); });
    const BoundaryFeatures features(mirrored);
    const ShapeEnergy energy(mirrored, features.dofs(), {features.orientation(0)});
    CHECK(features.orientation(0) == -1);
    CHECK(energy.value(points_of(mirrored, features.dofs()), {.shape_ratio_weight = 1.0}) ==
          Approx(2.0).epsilon(rounding));
}

}  // namespace couture::meshing
