#include "rom/reduced_model.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "iga/core/error.h"
#include "tests/rom/box_family.h"

using namespace couture;
using namespace couture::rom;
using Catch::Contains;
using couture::tests::BoxFamily;

namespace {

/// The family's geometry is linear in its parameters, so is its displacement in one of them.
const ReducedModelOptions linear_trend{.kriging = {.trend = Trend::linear}};

const SnapshotSet& family() {
    static const SnapshotSet set = BoxFamily::snapshots();
    return set;
}

const ReducedModel& separate() {
    static const ReducedModel model(family(), linear_trend);
    return model;
}

const ReducedModel& stacked() {
    static const ReducedModel model(family(), [] {
        ReducedModelOptions options = linear_trend;
        options.basis = BasisKind::stacked;
        return options;
    }());
    return model;
}

/// Away from the points of the design.
VectorX somewhere() { return BoxFamily::point({0.3, 0.7, 0.9, 0.2, 0.1, 0.6}); }

double relative_error(const VectorX& value, const VectorX& expected) {
    return (value - expected).norm() / expected.norm();
}

/// What the best of the snapshots would do.
double nearest_error(const MatrixX& snapshots, const VectorX& expected) {
    return (snapshots.colwise() - expected).colwise().norm().minCoeff() / expected.norm();
}

/// Random members and displacements l u_g under loads l that are not factored: 5 geometries.
SnapshotSet random_family() {
    SnapshotSet set{ParameterSpace({{"size", ParameterGroup::geometry, "", 0.0, 1.0},
                                    {"force", ParameterGroup::load, "", 1.0, 2.0}}),
                    {0, 0},
                    Vector2(0.5, 1.5),
                    BoxFamily::geometry(BoxFamily::parameters().centre()),
                    full_design(1, 5),
                    {full_design(1, 3)},
                    {},
                    {}};
    const iga::Space<3> space(set.reference);
    const VectorX reference = to_field(space, set.reference);
    const int n = 3 * space.n_dofs();
    set.control_points = random_design(5, n, 7).array() - 0.5;
    set.control_points.col(2).setZero();  // the reference member is the third
    set.control_points.colwise() += reference;
    const MatrixX shapes = random_design(5, n, 8).array() - 0.5;
    set.displacements.resize(n, 15);
    for (int i = 0; i < 15; ++i) {
        set.displacements.col(i) = (1.0 + 0.5 * (i % 3)) * shapes.col(i / 3);
    }
    return set;
}

/// Displacements that grow by a factor of 150 along the geometry and turn a little.
VectorX growing(double size, double force, Eigen::Index n) {
    const MatrixX shapes = random_design(2, static_cast<int>(n), 9).array() - 0.5;
    return std::exp(5.0 * size) * force * (shapes.col(0) + 0.2 * size * shapes.col(1));
}

SnapshotSet growing_family() {
    SnapshotSet set = random_family();
    for (int i = 0; i < 15; ++i) {
        set.displacements.col(i) =
            growing(0.25 * (i / 3), 1.0 + 0.5 * (i % 3), set.displacements.rows());
    }
    return set;
}

}  // namespace

TEST_CASE("ReducedModel: where displacements point alike, their length is learned apart", "[rom]") {
    const SnapshotSet set = growing_family();
    const ReducedModel model(set, {});
    REQUIRE(model.parts().amplitude);
    const ReducedModel plain(set, {.amplitude = Amplitude::none});
    CHECK_FALSE(plain.parts().amplitude);
    const Vector2 point(0.4, 1.3);
    const VectorX expected = growing(0.4, 1.3, set.displacements.rows());
    const double error = relative_error(model.evaluate(point).displacement, expected);
    CHECK(error < 0.01);
    CHECK(error < 0.2 * relative_error(plain.evaluate(point).displacement, expected));
    CHECK(model.errors(point).displacement.relative > 0.1 * error);
    const EvaluationGradient gradient = model.gradient(point);
    for (int i = 0; i < 2; ++i) {
        const Vector2 step = 1e-5 * Vector2::Unit(i);
        const VectorX difference = (model.evaluate(point + step).displacement -
                                    model.evaluate(point - step).displacement) /
                                   2e-5;
        CHECK(relative_error(gradient.displacement.col(i), difference) < 1e-4);
    }
    // One direction and its opposite are not alike.
    SnapshotSet turned = set;
    turned.displacements.col(4) *= -1.0;
    CHECK_FALSE(ReducedModel(turned, {}).parts().amplitude);
}

TEST_CASE("ReducedModel: a family of rank r is recovered exactly", "[rom]") {
    REQUIRE(separate().parts().models[0].n_modes() == 2);
    const VectorX expected = to_field(*separate().space(), BoxFamily::geometry(somewhere()));
    CHECK(relative_error(separate().evaluate(somewhere()).control_points, expected) < 1e-10);
    const MatrixX modes = separate().geometry_modes();
    const FieldPart& part = separate().parts().geometry;
    // Orthonormal in the mass matrix: mean products are over the volume.
    const double volume = iga::volume(family().reference);
    CHECK((part.gram * volume - MatrixX::Identity(2, 2)).norm() < 1e-12);
    CHECK(part.truncation < 1e-12);
}

TEST_CASE("ReducedModel: predicts full solutions", "[rom]") {
    const ReducedModel& model = GENERATE_REF(std::cref(separate()), std::cref(stacked())).get();
    const Evaluation there = model.evaluate(somewhere());
    CHECK(there.distance_outside == 0.0);
    const VectorX u = BoxFamily::solve(somewhere());
    const VectorX x = to_field(*model.space(), BoxFamily::geometry(somewhere()));
    CHECK(relative_error(there.displacement, u) <
          0.25 * nearest_error(there.factor * family().displacements, u));
    CHECK(relative_error(there.control_points, x) <
          0.25 * nearest_error(family().control_points, x));
    // At a point of the design.
    const VectorX corner = BoxFamily::point({0.0, 1.0, 0.4, 0.5, 0.3, 1.0});
    CHECK(relative_error(model.evaluate(corner).displacement, BoxFamily::solve(corner)) < 1e-5);
}

TEST_CASE("ReducedModel: factored parameters are exact", "[rom]") {
    VectorX point = somewhere();
    const VectorX once = separate().evaluate(point).displacement;
    point[BoxFamily::force] *= 3.0;
    point[BoxFamily::youngs_modulus] *= 0.5;
    const Evaluation other = separate().evaluate(point);
    CHECK(relative_error(other.displacement, 6.0 * once) < 1e-14);
    const VectorX solved = BoxFamily::solve(point);
    CHECK(relative_error(solved, 6.0 * BoxFamily::solve(somewhere())) < 1e-9);
    // Far outside of the box, but exact in these.
    CHECK(other.distance_outside > 0.5);
    CHECK(relative_error(other.displacement, solved) ==
          Approx(relative_error(once, BoxFamily::solve(somewhere()))).epsilon(1e-3));
}

TEST_CASE("ReducedModel: gradients are those of the values", "[rom]") {
    const ReducedModel& model = GENERATE_REF(std::cref(separate()), std::cref(stacked())).get();
    const EvaluationGradient gradient = model.gradient(somewhere());
    for (int i = 0; i < 6; ++i) {
        const Parameter& parameter = model.parameters().parameters()[i];
        // Of fourth order: the step can be so long that rounding does not show.
        const double step = 2e-3 * (parameter.upper - parameter.lower);
        const auto at = [&](double steps) {
            return model.evaluate(somewhere() + steps * step * VectorX::Unit(6, i));
        };
        const auto difference = [&](const auto& field) {
            return VectorX((8.0 * (field(at(1)) - field(at(-1))) - (field(at(2)) - field(at(-2)))) /
                           (12.0 * step));
        };
        const VectorX dx = difference([](const Evaluation& one) { return one.control_points; });
        const VectorX du = difference([](const Evaluation& one) { return one.displacement; });
        // Over the range of the parameter, so that units don't matter.
        const double range = parameter.upper - parameter.lower;
        CHECK(range * (gradient.control_points.col(i) - dx).norm() <
              1e-6 * (1.0 + range * gradient.control_points.col(i).norm()));
        CHECK((gradient.displacement.col(i) - du).norm() <
              1e-5 * gradient.displacement.col(i).norm());
    }
}

TEST_CASE("ReducedModel: the gradient by a factored load where it vanishes", "[rom]") {
    VectorX point = somewhere();
    const VectorX expected = separate().evaluate(point).displacement / point[BoxFamily::force];
    point[BoxFamily::force] = 0.0;
    CHECK(separate().evaluate(point).displacement.norm() == 0.0);
    CHECK(relative_error(separate().gradient(point).displacement.col(BoxFamily::force), expected) <
          1e-14);
}

TEST_CASE("ReducedModel: several points at once", "[rom]") {
    const ReducedModel& model = GENERATE_REF(std::cref(separate()), std::cref(stacked())).get();
    MatrixX points(3, 6);
    points.row(0) = somewhere();
    points.row(1) = model.parameters().centre();
    points.row(2) = BoxFamily::point({1.0, 0.0, 0.4, 1.2, 0.3, 0.1});
    const EvaluationBatch batch = model.evaluate_batch(points);
    for (int i = 0; i < 3; ++i) {
        const Evaluation one = model.evaluate(points.row(i));
        CHECK(relative_error(batch.control_points.col(i), one.control_points) < 1e-13);
        CHECK(relative_error(batch.displacements.col(i), one.displacement) < 1e-12);
    }
}

TEST_CASE("ReducedModel: ranks are at most those of the design", "[rom]") {
    const SnapshotSet set = random_family();
    const ReducedModelOptions asked{.n_modes = 12};
    const ReducedModel separated(set, asked);
    CHECK(separated.parts().models[0].n_modes() == 4);
    CHECK(separated.parts().models[1].n_modes() == 5);
    CHECK(separated.parts().models[1].missing_modes() ==
          "12 modes asked for, 5 are there: the numerical rank of 15 snapshots");
    ReducedModelOptions together = asked;
    together.basis = BasisKind::stacked;
    const ReducedModel one(set, together);
    REQUIRE(one.parts().models.size() == 1);
    CHECK(one.parts().models[0].n_modes() == 10);
    // Both blocks have the same weight.
    const VectorX sizes = one.parts().models[0].basis().singular_values;
    const double weight = iga::volume(set.reference);
    CHECK(sizes.squaredNorm() == Approx(2.0 * 15.0 * weight));
}

TEST_CASE("ReducedModel: refused snapshots are left out", "[rom]") {
    SnapshotSet set = family();
    BoxFamily::refuse(set.displacements, 40);
    BoxFamily::refuse(set.control_points, 3);
    for (int m = 0; m < 9; ++m) {
        BoxFamily::refuse(set.displacements, 27 + m);
    }
    const VectorX u = BoxFamily::solve(somewhere());
    for (const BasisKind basis : {BasisKind::separate, BasisKind::stacked}) {
        ReducedModelOptions options = linear_trend;
        options.basis = basis;
        options.n_modes = 8;
        const ReducedModel all(family(), options);
        const ReducedModel model(set, options);
        CHECK(all.parts().models.back().coefficients().design().sizes() ==
              std::vector<int>{9, 3, 3});
        CHECK(model.parts().models.back().coefficients().design().sizes() == std::vector<int>{71});
        CHECK(relative_error(model.evaluate(somewhere()).displacement, u) <
              3.0 * relative_error(all.evaluate(somewhere()).displacement, u));
    }
}

TEST_CASE("ReducedModel: error estimates", "[rom]") {
    ReducedModel model(family(), {.n_modes = 3, .kriging = {.trend = Trend::linear}});
    const VectorX corner = BoxFamily::point({0.0, 1.0, 0.4, 0.5, 0.3, 1.0});
    const ErrorEstimate known = model.errors(corner).displacement;
    const ErrorEstimate unknown = model.errors(somewhere()).displacement;
    CHECK(known.kriging < 1e-2 * unknown.kriging);
    CHECK(unknown.total > unknown.truncation);
    // Truncation is (1.14) of the snapshots, as a length.
    const FieldModel& field = model.parts().models[1];
    const double volume = iga::volume(family().reference);
    const double snapshots = std::sqrt(field.basis().singular_values.squaredNorm() / 81.0 / volume);
    CHECK(model.parts().displacement.truncation ==
          Approx(field.basis().relative_error(3) * snapshots).epsilon(1e-6));
    // Errors grow with the displacement.
    VectorX twice = somewhere();
    twice[BoxFamily::force] *= 2.0;
    CHECK(model.errors(twice).displacement.total == Approx(2.0 * unknown.total));
    CHECK(model.errors(twice).displacement.relative == Approx(unknown.relative));
    model.set_calibration({.geometry = 2.0, .displacement = 3.0, .von_mises = 1.5, .n_points = 9});
    const ErrorEstimates calibrated = model.errors(somewhere());
    CHECK(calibrated.displacement.total == Approx(3.0 * unknown.total));
    CHECK(calibrated.von_mises == Approx(1.5 * 3.0 * unknown.relative));
}

TEST_CASE("ReducedModel: estimates cover the errors of most points", "[rom]") {
    const MatrixX points = latin_hypercube_design(6, 10, 3);
    int n_covered = 0;
    for (int i = 0; i < 10; ++i) {
        const VectorX point = BoxFamily::parameters().from_unit(points.row(i));
        const VectorX u = BoxFamily::solve(point);
        const double error = relative_error(separate().evaluate(point).displacement, u);
        n_covered += error <= separate().errors(point).displacement.relative ? 1 : 0;
    }
    CHECK(n_covered >= 9);
}

TEST_CASE("ReducedModel: standard errors of coefficients and of the field", "[rom]") {
    const ReducedModel& model = separate();
    const VectorX errors = model.displacement_standard_errors(somewhere());
    const double factor = model.evaluate(somewhere()).factor;
    const VectorX field = model.displacement_error_field(somewhere());
    CHECK(field.cwiseAbs2().isApprox(
        factor * factor * (model.displacement_modes().cwiseAbs2() * errors.cwiseAbs2()), 1e-10));
    CHECK(model.geometry_standard_errors(somewhere()).size() == 2);
}

TEST_CASE("ReducedModel: modes, mean and coefficients give the fields", "[rom]") {
    const ReducedModel& model = GENERATE_REF(std::cref(separate()), std::cref(stacked())).get();
    const Evaluation there = model.evaluate(somewhere());
    CHECK(
        relative_error(model.geometry_mean() + model.geometry_modes() * there.geometry_coefficients,
                       there.control_points) < 1e-13);
    CHECK(relative_error(
              there.factor * (model.displacement_mean() +
                              model.displacement_modes() * there.displacement_coefficients),
              there.displacement) < 1e-12);
    CHECK(relative_error(to_field(*model.space(), model.member(there)), there.control_points) <
          1e-14);
    CHECK(model.displacement_field(there).coefficients.row(5).transpose() ==
          there.displacement.segment<3>(15));
}

TEST_CASE("ReducedModel: only loads vary", "[rom]") {
    SnapshotSet set = random_family();
    set.parameters = ParameterSpace({{"force", ParameterGroup::load, "", 1.0, 2.0},
                                     {"lift", ParameterGroup::load, "", 0.0, 1.0}});
    set.factor_power = {0, 1};
    set.reference_point = Vector2(1.5, 0.5);
    set.geometry_points = MatrixX(1, 0);
    set.control_points = MatrixX(set.control_points.leftCols(1));
    set.displacements = MatrixX(set.displacements.leftCols(3));
    const BasisKind basis = GENERATE(BasisKind::separate, BasisKind::stacked);
    ReducedModelOptions options;
    options.basis = basis;
    const ReducedModel model(set, options);
    const Evaluation there = model.evaluate(Vector2(1.5, 0.25));
    CHECK(relative_error(there.control_points, set.control_points.col(0)) < 1e-12);
    // A point of the design, under half the lift.
    CHECK(relative_error(there.displacement, 0.5 * set.displacements.col(1)) < 1e-6);
    SECTION("and these only by a factor") {
        set.factor_power = {1, 1};
        set.mechanics_factors.clear();
        set.displacements = MatrixX(set.displacements.leftCols(1));
        const ReducedModel constant(set, options);
        const Evaluation scaled = constant.evaluate(Vector2(1.0, 1.5));
        CHECK(relative_error(scaled.displacement, 2.0 * set.displacements.col(0)) < 1e-12);
        CHECK(constant.errors(Vector2(1.0, 1.5)).displacement.total == 0.0);
    }
}

TEST_CASE("calibration_factor: the factor that covers a part of the points", "[rom]") {
    const VectorX errors = (VectorX(4) << 1.0, 4.0, 3.0, 2.0).finished();
    CHECK(calibration_factor(errors, VectorX::Ones(4), 0.75) == 3.0);
    CHECK(calibration_factor(errors, 2.0 * VectorX::Ones(4), 1.0) == 2.0);
    CHECK_THROWS_WITH(calibration_factor(errors, VectorX::Ones(3)),
                      Contains("4 errors and 3 estimates"));
    CHECK_THROWS_WITH(calibration_factor(errors, VectorX::Zero(4)), Contains("is not positive"));
}

TEST_CASE("ReducedModel: refuses points that do not fit", "[rom]") {
    CHECK_THROWS_WITH(separate().evaluate(Vector3(1.0, 2.0, 3.0)),
                      Contains("a point with 3 values; expected one for each of 6 parameters"));
    VectorX point = somewhere();
    point[BoxFamily::lift] = std::nan("");
    CHECK_THROWS_WITH(separate().evaluate(point), Contains("'lift' is nan; it must be finite"));
    point = somewhere();
    point[BoxFamily::youngs_modulus] = 0.0;
    CHECK_THROWS_WITH(separate().evaluate(point), Contains("'youngs_modulus' is 0"));
}

TEST_CASE("ReducedModel: parts that do not fit together are refused", "[rom]") {
    ReducedModelParts parts = separate().parts();
    parts.models.pop_back();
    CHECK_THROWS_WITH(ReducedModel(parts), Contains("1 field models; expected 2"));
    parts = separate().parts();
    std::swap(parts.models[0], parts.models[1]);
    CHECK_THROWS_AS(ReducedModel(parts), InputError);
    parts = separate().parts();
    parts.factor_power.pop_back();
    CHECK_THROWS_WITH(ReducedModel(parts), Contains("5 powers"));
}
