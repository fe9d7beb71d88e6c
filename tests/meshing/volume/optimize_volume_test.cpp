#include "meshing/volume/optimize_volume.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "iga/core/error.h"
#include "iga/core/parallel.h"
#include "iga/topology/element_quality.h"
#include "iga/topology/jacobian_certificate.h"
#include "tests/meshing/volume/volume_samples.h"

namespace couture::meshing {

using iga::MultiPatch;

namespace {

/// Points stay in planes, and volumes between planes stay, to rounding.
constexpr double rounding = 1e-12;

iga::Validity worst_validity(const MultiPatch<3>& volume) {
    iga::Validity worst = iga::Validity::valid;
    for (const iga::Volume& patch : volume.patches) {
        worst = std::max(worst, iga::certify<3>(patch).validity);
    }
    return worst;
}

/// Moves the inner control points of a body at random.
MultiPatch<3> shaken(const MultiPatch<3>& volume, double size) {
    const BoundaryFeatures features(volume);
    MatrixX points = points_of(volume, features.dofs());
    std::mt19937 generator(1);
    std::uniform_real_distribution<double> uniform(-size, size);
    for (int i = 0; i < points.cols(); ++i) {
        const Vector3 change(uniform(generator), uniform(generator), uniform(generator));
        if (features.freedom(i) == Freedom::interior) {
            points.col(i) += change;
        }
    }
    return with_points(volume, features.dofs(), points);
}

/// Elements of the unit cube crowd and slant while its faces stay.
Vector3 crowded(const Vector3& x) {
    return {x[0] + 0.9 * x[0] * (1.0 - x[0]) * (2.0 * x[2] - 1.0),
            x[1] + 0.8 * x[1] * (1.0 - x[1]) * (2.0 * x[0] - 1.0), x[2]};
}

/// Twists a cylinder of length 2 and moves its sections along the axis.
Vector3 twisted(const Vector3& x) {
    const double angle = 0.75 * x[2] * (x[0] * x[0] + x[1] * x[1]);
    return {std::cos(angle) * x[0] - std::sin(angle) * x[1],
            std::sin(angle) * x[0] + std::cos(angle) * x[1],
            x[2] + 0.5 * x[2] * (1.0 - 0.5 * x[2]) * x[0]};
}

}  // namespace

TEST_CASE("optimize_volume: a shaken cube becomes cubes again", "[volume]") {
    for (const int degree : {1, 2, 3}) {
        const MultiPatch<3> cube = cube_of(degree, 5);
        const OptimizedVolume result =
            optimize_volume(shaken(cube, degree == 1 ? 0.05 : 0.04), BoundaryFeatures(cube));
        CAPTURE(degree, result.report.before.max_shape_ratio, result.report.after.max_shape_ratio);
        CHECK(result.report.after.max_shape_ratio < 1.001 * std::sqrt(3.0));
        CHECK(result.report.after.min_scaled_jacobian > 0.999);
        CHECK(iga::element_quality(result.volume).min_scaled_jacobian > 0.999);
    }
}

TEST_CASE("optimize_volume: points slide in plane faces across patches, corners stay", "[volume]") {
    for (const int degree : {1, 2}) {
        MultiPatch<3> cube = two_patch_cube(degree, 8);
        cube.boundary_sets["top"] = {iga::make_side<3>(0, 5), iga::make_side<3>(1, 5)};
        const MultiPatch<3> deformed = moved(cube, crowded);
        const BoundaryFeatures features(cube);
        const OptimizedVolume result = optimize_volume(deformed, features);
        CAPTURE(degree, result.report.before.max_shape_ratio, result.report.after.max_shape_ratio);
        CHECK(result.report.after.max_shape_ratio < 0.7 * result.report.before.max_shape_ratio);
        CHECK(result.report.after.min_scaled_jacobian > result.report.before.min_scaled_jacobian);
        CHECK(std::abs(result.report.volume_change) < rounding);
        CHECK(iga::signature(result.volume) == iga::signature(cube));
        CHECK(result.volume.boundary_sets == cube.boundary_sets);
        CHECK_NOTHROW(iga::check(result.volume));
        CHECK(worst_validity(result.volume) == iga::Validity::valid);

        const MatrixX old_points = points_of(deformed, features.dofs());
        const MatrixX points = points_of(result.volume, features.dofs());
        for (const int corner : features.corners()) {
            CHECK(points.col(corner) == old_points.col(corner));
        }
        double largest_slide = 0.0;
        for (int i = 0; i < points.cols(); ++i) {
            if (features.freedom(i) == Freedom::interior) {
                continue;
            }
            largest_slide = std::max(largest_slide, (points.col(i) - old_points.col(i)).norm());
            for (int k = 0; k < 3; ++k) {
                if (old_points(k, i) == 0.0 || old_points(k, i) == 1.0) {
                    CHECK(std::abs(points(k, i) - old_points(k, i)) < rounding);
                }
            }
        }
        CHECK(largest_slide > 0.1);
    }
}

TEST_CASE("optimize_volume: a sheared block, whose sharp edges bound the shape ratio", "[volume]") {
    // No element at an edge of angle theta can have a shape ratio below 1 / sin(theta / 2).
    const double gamma = 1.5;
    const double bound = 1.0 / std::sin(0.5 * std::atan(1.0 / gamma));
    const MultiPatch<3> cube = cube_of(1, 8);
    const MultiPatch<3> sheared =
        moved(cube, [&](const Vector3& x) { return Vector3(x[0] + gamma * x[2], x[1], x[2]); });
    const OptimizedVolume result = optimize_volume(sheared, BoundaryFeatures(cube));
    const VolumeOptimizationReport& report = result.report;
    CAPTURE(bound, report.before.max_shape_ratio, report.after.max_shape_ratio);
    CHECK(report.after.max_shape_ratio > bound);
    CHECK(report.after.max_shape_ratio < 0.88 * report.before.max_shape_ratio);
    CHECK(report.energy_after < 0.7 * report.energy_before);
    CHECK(report.after.min_scaled_jacobian > 0.97 * report.before.min_scaled_jacobian);
    CHECK(std::abs(report.volume_change) < rounding);
}

TEST_CASE("optimize_volume: a state that can't be bettered is returned as it is", "[volume]") {
    const MultiPatch<3> cube = cube_of(2, 3);
    const BoundaryFeatures features(cube);
    const OptimizedVolume result = optimize_volume(cube, features);
    CHECK((points_of(result.volume, features.dofs()) - points_of(cube, features.dofs()))
              .cwiseAbs()
              .maxCoeff() < rounding);
}

TEST_CASE("optimize_volume: a boundary that must not slide stays", "[volume]") {
    const MultiPatch<3> cube = cube_of(1, 5);
    const MultiPatch<3> deformed = moved(cube, crowded);
    const BoundaryFeatures features(cube);
    const OptimizedVolume result = optimize_volume(deformed, features, {.slide_boundary = false});
    const MatrixX old_points = points_of(deformed, features.dofs());
    const MatrixX points = points_of(result.volume, features.dofs());
    for (int i = 0; i < points.cols(); ++i) {
        if (features.freedom(i) != Freedom::interior) {
            CHECK(points.col(i) == old_points.col(i));
        }
    }
    CHECK(result.report.after.max_shape_ratio <= result.report.before.max_shape_ratio);
}

TEST_CASE("optimize_volume: a twisted cylinder keeps its shape", "[volume]") {
    for (const int degree : {1, 2, 3}) {
        std::vector<double> distances;
        for (const int n : {3, 7}) {
            const MultiPatch<3> part = part_of("cylinder_o_grid", degree, n);
            const MultiPatch<3> deformed = moved(part, twisted);
            const OptimizedVolume result = optimize_volume(deformed, BoundaryFeatures(part));
            const VolumeOptimizationReport& report = result.report;
            CAPTURE(degree, n, report.before.max_shape_ratio, report.after.max_shape_ratio,
                    report.boundary_distance, report.volume_change);
            CHECK(report.after.max_shape_ratio < 0.7 * report.before.max_shape_ratio);
            CHECK(report.after.min_scaled_jacobian > report.before.min_scaled_jacobian);
            CHECK(iga::signature(result.volume) == iga::signature(part));
            CHECK(worst_validity(result.volume) == iga::Validity::valid);
            CHECK(report.boundary_distance < 0.02 * deformed.size());
            distances.push_back(report.boundary_distance);
        }
        CAPTURE(degree, distances[0], distances[1]);
        CHECK(distances[1] < 0.7 * distances[0]);
    }
}

TEST_CASE("optimize_volume: a folded corner is unfolded", "[volume]") {
    for (const int degree : {1, 2}) {
        const MultiPatch<3> cube = cube_of(degree, 4);
        const BoundaryFeatures features(cube);
        MatrixX points = points_of(cube, features.dofs());
        // An inner point next to the corner pushed out through it.
        int nearest = -1;
        for (int i = 0; i < points.cols(); ++i) {
            if (features.freedom(i) == Freedom::interior &&
                (nearest < 0 || points.col(i).norm() < points.col(nearest).norm())) {
                nearest = i;
            }
        }
        points.col(nearest) -= Vector3::Constant(0.5 * degree);
        const MultiPatch<3> folded = with_points(cube, features.dofs(), points);
        REQUIRE(worst_validity(folded) == iga::Validity::folded);
        const OptimizedVolume result = optimize_volume(folded, features);
        CHECK(result.report.untangling_rounds > 0);
        CHECK(std::isinf(result.report.energy_before));
        CHECK(worst_validity(result.volume) == iga::Validity::valid);
        CHECK(result.report.after.max_shape_ratio < 1.01 * std::sqrt(3.0));
    }
}

TEST_CASE("optimize_volume: bit-identical for 1 and 2 threads", "[volume]") {
    const MultiPatch<3> part = part_of("cylinder_o_grid", 2, 3);
    const MultiPatch<3> deformed = moved(part, twisted);
    const BoundaryFeatures features(part);
    const int threads = n_threads();
    set_n_threads(1);
    const OptimizedVolume one = optimize_volume(deformed, features, {.max_rounds = 4});
    set_n_threads(2);
    const OptimizedVolume two = optimize_volume(deformed, features, {.max_rounds = 4});
    set_n_threads(threads);
    CHECK(points_of(one.volume, features.dofs()) == points_of(two.volume, features.dofs()));
    CHECK(one.report.boundary_distance == two.report.boundary_distance);
}

TEST_CASE("optimize_volume: errors", "[volume]") {
    const MultiPatch<3> cube = cube_of(1, 3);
    const BoundaryFeatures features(cube);
    CHECK_THROWS_AS(optimize_volume(cube_of(2, 3), features), TopologyError);
    CHECK_THROWS_WITH(optimize_volume(cube_of(2, 3), features),
                      Catch::Contains("both must come from the same initial body"));
    CHECK_THROWS_AS(optimize_volume(cube, features, {.max_rounds = -1}), InputError);
    CHECK_THROWS_AS(optimize_volume(cube, features, {.tolerance = -1.0}), InputError);
    // A corner of the body, which must stay, pushed through it.
    const MultiPatch<3> folded =
        moved(cube, [](const Vector3& x) { return x.sum() > 2.9 ? Vector3::Constant(0.2) : x; });
    CHECK_THROWS_AS(optimize_volume(folded, features), GeometryError);
    CHECK_THROWS_WITH(
        optimize_volume(folded, features),
        Catch::Contains("patch 0 is folded at xi = (") && Catch::Contains("it must be positive"));
}

}  // namespace couture::meshing
