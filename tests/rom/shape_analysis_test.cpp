#include "rom/shape_analysis.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "iga/core/error.h"
#include "tests/rom/shape_samples.h"

using namespace couture;
using namespace couture::rom;
using namespace couture::tests;
using Catch::Matchers::Contains;

namespace {

/// The direction of a mode that only scales one coordinate of the sphere's points.
MatrixX scaling(int axis) {
    MatrixX direction = MatrixX::Zero(24, 3);
    direction.col(axis) = sphere_points().col(axis);
    return direction / direction.norm();
}

}  // namespace

TEST_CASE("make_shape_model: two modes of ellipsoids are recovered, wherever they lie", "[rom]") {
    constexpr double a = 0.05;
    const bool is_moved = GENERATE(false, true);
    std::vector<MatrixX> shapes = ellipsoids(a);
    // Where the mean is, so that modes can be compared.
    if (is_moved) {
        const MatrixX middle = shapes[4];
        shapes = moved(shapes);
        shapes[4] = middle;
    }
    const ShapeModel model = make_shape_model(shapes);
    REQUIRE(model.n_modes() == 2);
    CHECK(model.reference == 4);
    CHECK((model.mean - sphere_points()).norm() < 1e-12);
    for (int k = 0; k < 2; ++k) {
        CHECK(std::abs((mode_shape(model, k).cwiseProduct(scaling(k))).sum()) ==
              Approx(1.0).epsilon(1e-12));
        // Factors -1, 0, 1 three times each: the sum of squares is 6, over 9 - 1.
        const double step = (k == 0 ? 2.0 * a : a) * sphere_points().col(k).norm();
        CHECK(model.standard_deviations[k] == Approx(step * std::sqrt(6.0 / 8.0)).epsilon(1e-11));
    }
}

TEST_CASE("make_shape_model: modes are orthonormal and hold all members", "[rom]") {
    const auto alignment = GENERATE(Alignment::none, Alignment::rigid, Alignment::similarity);
    const std::vector<MatrixX> shapes = random_shapes(7, 30, 0.2);
    const ShapeModel model = make_shape_model(shapes, {.alignment = alignment});
    REQUIRE(model.n_modes() == 6);
    CHECK(model.n_members() == 7);
    CHECK((model.modes.transpose() * model.modes - MatrixX::Identity(6, 6)).norm() < 1e-12);
    CHECK(model.coefficients.rowwise().sum().norm() < 1e-12);
    for (int k = 0; k < 6; ++k) {
        CHECK(model.coefficients.row(k).norm() / std::sqrt(6.0) ==
              Approx(model.standard_deviations[k]));
        if (k > 0) CHECK(model.standard_deviations[k] <= model.standard_deviations[k - 1]);
    }
    for (int j = 0; j < 7; ++j) {
        const MatrixX member = virtual_member(model, model.coefficients.col(j));
        CHECK(rms_distance(member, model.motions[j].apply(shapes[j])) < 1e-12);
    }
}

TEST_CASE("make_shape_model: no mode is a rigid motion", "[rom]") {
    const ShapeModel model = make_shape_model(moved(random_shapes(10, 25, 0.05)));
    const MatrixX centred = model.mean.rowwise() - model.mean.colwise().mean();
    for (int k = 0; k < model.n_modes(); ++k) {
        const MatrixX mode = mode_shape(model, k);
        CHECK(mode.colwise().sum().norm() < 1e-12);
    }
    // Each member is turned so that its covariance with the mean is symmetric.
    for (int j = 0; j < model.n_members(); ++j) {
        const Matrix<3> covariance =
            virtual_member(model, model.coefficients.col(j)).transpose() * centred;
        CHECK((covariance - covariance.transpose()).norm() < 1e-10);
    }
}

TEST_CASE("make_shape_model: mirror images are found", "[rom]") {
    std::vector<MatrixX> shapes = random_shapes(5, 30, 0.05);
    shapes[3].col(0) *= -1.0;
    CHECK(make_shape_model(shapes).mirrored_members == std::vector<int>{3});
    CHECK(make_shape_model(random_shapes(5, 30, 0.05)).mirrored_members.empty());
}

TEST_CASE("project_shape: a member has its own coefficients and is its own nearest", "[rom]") {
    const auto alignment = GENERATE(Alignment::none, Alignment::rigid, Alignment::similarity);
    const std::vector<MatrixX> shapes = random_shapes(7, 30, 0.2);
    const ShapeModel model = make_shape_model(shapes, {.alignment = alignment});
    for (int j = 0; j < 7; ++j) {
        MatrixX points = shapes[j];
        if (alignment != Alignment::none) points = rigid_motion(j).apply(points);
        if (alignment == Alignment::similarity) points *= 3.0;
        const ShapeProjection projection = project_shape(model, points, 6);
        CHECK((projection.coefficients - model.coefficients.col(j)).norm() < 1e-11);
        CHECK(projection.distance < 1e-12);
        CHECK(projection.max_distance < 1e-11);
        REQUIRE(projection.nearest.size() == 3);
        CHECK(projection.nearest[0].member == j);
        CHECK(projection.nearest[0].distance < 1e-12);
        CHECK(projection.nearest[1].distance <= projection.nearest[2].distance);
    }
}

TEST_CASE("project_shape: an ellipsoid between the members, and one beside them", "[rom]") {
    const ShapeModel model = make_shape_model(ellipsoids(0.05));
    // 1.06 and 0.97 are 0.6 of a step of 0.1 and -0.6 of a step of 0.05.
    const ShapeProjection inside =
        project_shape(model, rigid_motion(5).apply(ellipsoid(1.06, 0.97, 1.0)), 2);
    CHECK(std::abs(inside.scores[0]) == Approx(0.6 / std::sqrt(0.75)).epsilon(1e-10));
    CHECK(std::abs(inside.scores[1]) == Approx(0.6 / std::sqrt(0.75)).epsilon(1e-10));
    CHECK(inside.distance < 1e-12);
    CHECK(inside.nearest[0].member == 6);
    CHECK(rms_distance(inside.points, ellipsoid(1.06, 0.97, 1.0)) < 1e-12);
    // The third axis is in no mode.
    const ShapeProjection beside = project_shape(model, ellipsoid(1.0, 1.0, 1.1), 2);
    const VectorX heights = 0.1 * sphere_points().col(2);
    CHECK(beside.coefficients.norm() < 1e-12);
    CHECK(beside.distance == Approx(heights.norm() / std::sqrt(24.0)).epsilon(1e-11));
    CHECK(beside.max_distance == Approx(heights.cwiseAbs().maxCoeff()).epsilon(1e-11));
    CHECK(beside.distance_to_mean == Approx(beside.distance));
    // One mode leaves what the second one holds.
    const ShapeProjection first = project_shape(model, ellipsoid(1.0, 1.05, 1.0), 1);
    CHECK(first.distance ==
          Approx(0.05 * sphere_points().col(1).norm() / std::sqrt(24.0)).epsilon(1e-11));
}

TEST_CASE("shape analysis: refuses what it can't do", "[rom]") {
    const MatrixX shape = sphere_points();
    CHECK_THROWS_WITH(make_shape_model({shape}), Contains("1 members; a population has 2 or more"));
    CHECK_THROWS_WITH(make_shape_model(moved({shape, shape, shape})),
                      Contains("the 3 members are equal but for their places"));
    CHECK_THROWS_WITH(make_shape_model({shape, shape}, {.alignment = Alignment::none}),
                      Contains("the 2 members are equal; there is no variation"));
    const ShapeModel model = make_shape_model(ellipsoids(0.05));
    CHECK_THROWS_WITH(project_shape(model, shape.topRows(4), 1), Contains("4 x 3 coordinates"));
    CHECK_THROWS_WITH(project_shape(model, shape, 3), Contains("3 modes; there are 1 to 2"));
    CHECK_THROWS_WITH(project_shape(model, shape, 0), Contains("0 modes; there are 1 to 2"));
    CHECK_THROWS_WITH(virtual_member(model, VectorX::Ones(3)),
                      Contains("3 coefficients; there are 2 modes"));
}
