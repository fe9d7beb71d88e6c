#include "rom/field_model.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "iga/core/error.h"
#include "rom/designs.h"

using namespace couture;
using namespace couture::rom;

namespace {

constexpr int n_values = 30;

const VectorX mean = VectorX::LinSpaced(n_values, 1.0, 2.0);

/// mean + x a + y b + x y c: rank 3.
MatrixX bilinear_fields(const MatrixX& points) {
    const MatrixX directions = random_design(3, n_values, 5).array() - 0.5;
    MatrixX fields(n_values, points.rows());
    for (Eigen::Index j = 0; j < points.rows(); ++j) {
        const double x = points(j, 0);
        const double y = points(j, 1);
        fields.col(j) = mean + directions * Vector3(x, y, x * y);
    }
    return fields;
}

TensorDesign grid() { return {{full_design(1, 4), full_design(1, 3)}}; }

void refuse(MatrixX& fields, int column) {
    fields.col(column).setConstant(std::numeric_limits<double>::quiet_NaN());
}

}  // namespace

TEST_CASE("FieldModel: a family of rank r has r modes, orthonormal, and is learned exactly",
          "[rom]") {
    const InnerProduct product(3);
    const FieldModel model(grid(), bilinear_fields(grid().points()), mean, product);
    REQUIRE(model.n_modes() == 3);
    CHECK(model.basis().rank == 3);
    CHECK((model.basis().modes.transpose() * model.basis().modes - MatrixX::Identity(3, 3)).norm() <
          1e-12);
    const MatrixX training = model.coefficients().training().transpose();
    CHECK((model.fields(training) - bilinear_fields(grid().points())).norm() < 1e-12);
    // Between the points kriging of smooth functions: exact to its nugget.
    const Vector2 point(0.35, 0.8);
    const VectorX expected = bilinear_fields(point.transpose());
    const VectorX predicted = model.fields(model.coefficients().values(point));
    CHECK((predicted - expected).norm() < 1e-2 * (expected - mean).norm());
}

TEST_CASE("FieldModel: says so when fewer modes are possible than asked for", "[rom]") {
    const InnerProduct product(3);
    const MatrixX fields = bilinear_fields(grid().points());
    const FieldModel all(grid(), fields, mean, product, {.pod = {.n_modes = 10}});
    CHECK(all.missing_modes() ==
          "10 modes asked for, 3 are there: the numerical rank of 12 snapshots");
    const FieldModel two(grid(), fields, mean, product, {.pod = {.n_modes = 2}});
    CHECK(two.n_modes() == 2);
    CHECK_FALSE(two.missing_modes());
    const FieldModel some(grid(), fields, mean, product, {.pod = {.n_modes = 3, .tolerance = 0.5}});
    REQUIRE(some.n_modes() == 1);
    CHECK(some.missing_modes() == "3 modes asked for, 1 suffice for the tolerance");
}

TEST_CASE("accepted_design: a tensor product where that is left", "[rom]") {
    std::vector<int> all_but_second_row = {0, 1, 2, 6, 7, 8, 9, 10, 11};
    const TensorDesign rows = accepted_design(grid(), all_but_second_row);
    REQUIRE(rows.sizes() == std::vector<int>{3, 3});
    CHECK(rows.points() == grid().points()(all_but_second_row, Eigen::all));
    all_but_second_row.pop_back();
    const TensorDesign dense = accepted_design(grid(), all_but_second_row);
    REQUIRE(dense.sizes() == std::vector<int>{8});
    CHECK(dense.points() == grid().points()(all_but_second_row, Eigen::all));
}

TEST_CASE("FieldModel: refused fields are left out", "[rom]") {
    const InnerProduct product(3);
    MatrixX fields = bilinear_fields(grid().points());
    refuse(fields, 4);
    const FieldModel model(grid(), fields, mean, product);
    CHECK(model.n_modes() == 3);
    CHECK(model.coefficients().design().sizes() == std::vector<int>{11});
    const VectorX point = grid().points().row(4);
    const VectorX expected = bilinear_fields(point.transpose());
    CHECK((VectorX(model.fields(model.coefficients().values(point))) - expected).norm() <
          0.05 * (expected - mean).norm());
    fields.setConstant(std::numeric_limits<double>::quiet_NaN());
    CHECK_THROWS_WITH(FieldModel(grid(), fields, mean, product),
                      Catch::Contains("all 12 fields were refused"));
}

TEST_CASE("FieldModel: lengths of a design with holes are those of its complete part", "[rom]") {
    MatrixX fields = bilinear_fields(grid().points());
    refuse(fields, 4);
    const FieldModel model(grid(), fields, mean, InnerProduct(3));
    const CoefficientModel& coefficients = model.coefficients();
    // All but the second row of the grid, of which points 3 and 5 are left.
    const std::vector<int> positions = {0, 1, 2, 5, 6, 7, 8, 9, 10};
    const CoefficientModel part(accepted_design(grid(), {0, 1, 2, 6, 7, 8, 9, 10, 11}),
                                coefficients.training()(positions, Eigen::all),
                                coefficients.options());
    REQUIRE(part.design().sizes() == std::vector<int>{3, 3});
    for (int k = 0; k < 3; ++k) {
        CHECK(coefficients.parameters()[k].lengths == part.parameters()[k].lengths);
        CHECK(coefficients.parameters()[k].nugget >= part.parameters()[k].nugget);
        CHECK(coefficients.parameters()[k].nugget <= 1e-5);
    }
    // Points of the incomplete row count all the same.
    for (const int i : {3, 5}) {
        const VectorX point = grid().points().row(i);
        const double error = (model.field(coefficients.values(point)) - fields.col(i)).norm();
        const double without = (model.field(part.values(point)) - fields.col(i)).norm();
        CHECK(error < 0.1 * without);
    }
    SECTION("too little is complete: all points are searched") {
        for (const int column : {0, 7, 10}) {
            refuse(fields, column);
        }
        const FieldModel sparse(grid(), fields, mean, InnerProduct(3));
        CHECK(sparse.coefficients().design().sizes() == std::vector<int>{8});
        CHECK(sparse.n_modes() == 3);
    }
}

TEST_CASE("FieldModel: without inputs the field is constant", "[rom]") {
    const VectorX field = VectorX::LinSpaced(n_values, 3.0, 4.0);
    const FieldModel model({}, field, mean, InnerProduct(3));
    CHECK(model.n_modes() == 0);
    CHECK((VectorX(model.fields(model.coefficients().values(VectorX()))) - field).norm() < 1e-14);
}

TEST_CASE("FieldModel: fields that do not vary", "[rom]") {
    const MatrixX fields = mean.replicate(1, 12);
    const FieldModel model(grid(), fields, mean, InnerProduct(3));
    CHECK(model.basis().rank == 0);
    CHECK((VectorX(model.fields(model.coefficients().values(Vector2(0.2, 0.9)))) - mean).norm() <
          1e-12);
}

TEST_CASE("FieldModel: one field is as several", "[rom]") {
    const MatrixX fields = random_design(12, n_values, 9);
    for (const int n_modes : {1, 4, 7, 11}) {
        const FieldModel model(grid(), fields, mean, InnerProduct(3),
                               {.pod = {.n_modes = n_modes}});
        const MatrixX coefficients = random_design(2, n_modes, 4);
        const MatrixX both = model.fields(coefficients);
        CHECK((model.field(coefficients.col(1)) - both.col(1)).norm() < 1e-13 * both.norm());
    }
}

TEST_CASE("FieldModel: standard errors of values", "[rom]") {
    const FieldModel model(grid(), bilinear_fields(grid().points()), mean, InnerProduct(3));
    const VectorX variances = Vector3(4.0, 1.0, 0.25);
    const MatrixX covariance =
        model.basis().modes * variances.asDiagonal() * model.basis().modes.transpose();
    CHECK((model.standard_errors(variances) - covariance.diagonal().cwiseSqrt()).norm() < 1e-12);
}

TEST_CASE("FieldModel: refuses sizes that do not fit", "[rom]") {
    CHECK_THROWS_WITH(FieldModel(grid(), MatrixX::Ones(n_values, 5), mean, InnerProduct(3)),
                      Catch::Contains("5 fields of 30 values for a design of 12 points"));
}

TEST_CASE("learned_coefficients: of many points the coefficients share their lengths", "[rom]") {
    const MatrixX points = sobol_design(3, 700);
    const auto f = [](const VectorX& x) {
        return VectorX(
            Vector2(std::sin(2.0 * x[0]) * (1.0 + x[1]), 1.0 / (1.0 + x[0] + x[2] * x[1])));
    };
    MatrixX values(points.rows(), 2);
    std::vector<int> accepted;
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
        values.row(i) = f(points.row(i).transpose()).transpose();
        accepted.push_back(static_cast<int>(i));
    }
    const CoefficientModel model =
        learned_coefficients({{points}}, accepted, values, {.trend = Trend::automatic});
    CHECK(model.parameters()[0] == model.parameters()[1]);
    CHECK(model.options().trend != Trend::automatic);
    const VectorX somewhere = Vector3(0.21, 0.77, 0.43);
    CHECK((model.values(somewhere) - f(somewhere)).norm() < 1e-4);
    CHECK(model.leave_one_out().cwiseAbs().maxCoeff() < 1e-2);
}
