#include "rom/coefficient_model.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "iga/core/error.h"
#include "rom/designs.h"

using namespace couture;
using namespace couture::rom;

namespace {

TensorDesign tensor_design() { return {{star_design(2, 2), full_design(1, 4)}}; }

/// Three functions of three inputs.
MatrixX training(const TensorDesign& design) {
    const MatrixX points = design.points();
    MatrixX values(points.rows(), 3);
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
        const double x = points(i, 0);
        const double y = points(i, 1);
        const double z = points(i, 2);
        values.row(i) << std::sin(3.0 * x) + y * z, std::exp(x - y) * (1.0 + z), 1e-4 * x * y + z;
    }
    return values;
}

const VectorX somewhere = (VectorX(3) << 0.3, 0.62, 0.41).finished();

}  // namespace

TEST_CASE("CoefficientModel: all at once are the kriging models one by one", "[rom]") {
    const auto kind = GENERATE(CorrelationKind::matern_5_2, CorrelationKind::gaussian);
    const auto trend = GENERATE(Trend::constant, Trend::linear);
    const KrigingOptions options{.correlation = kind, .trend = trend};
    const TensorDesign design = GENERATE(tensor_design(), TensorDesign{{tensor_design().points()}});
    const CoefficientModel model(design, training(design), options);
    const VectorX values = model.values(somewhere);
    const VectorX variances = model.variances(somewhere);
    const MatrixX gradient = model.gradient(somewhere);
    for (int k = 0; k < 3; ++k) {
        const Kriging one(design, training(design).col(k), options, model.parameters()[k]);
        const Prediction expected = one.predict(somewhere);
        // Summed in another order: weights are large where K is nearly singular.
        const double rounding = 1e-13 * one.weights().norm() + 1e-12;
        CHECK(std::abs(values[k] - expected.value) < rounding);
        CHECK(variances[k] == expected.variance);
        CHECK((gradient.row(k).transpose() - expected.gradient).norm() < 100.0 * rounding);
        CHECK(model.leave_one_out().col(k) == one.leave_one_out());
    }
}

TEST_CASE("CoefficientModel: equal parameters share one matrix, and give the same", "[rom]") {
    const auto kind = GENERATE(CorrelationKind::matern_5_2, CorrelationKind::gaussian);
    const KrigingOptions options{.correlation = kind, .trend = Trend::linear};
    const TensorDesign design = GENERATE(tensor_design(), TensorDesign{{tensor_design().points()}});
    const KrigingParameters parameters{Vector3(0.7, 0.9, 1.1), 1e-8};
    const CoefficientModel model(design, training(design), options,
                                 {parameters, parameters, parameters});
    CHECK(model.models()[0].system() == model.models()[2].system());
    const VectorX values = model.values(somewhere);
    const VectorX variances = model.variances(somewhere);
    const MatrixX gradient = model.gradient(somewhere);
    for (int k = 0; k < 3; ++k) {
        const Kriging one(design, training(design).col(k), options, parameters);
        const Prediction expected = one.predict(somewhere);
        const double rounding = 1e-13 * one.weights().norm() + 1e-12;
        CHECK(std::abs(values[k] - expected.value) < rounding);
        CHECK(variances[k] == Approx(expected.variance).epsilon(1e-12));
        CHECK((gradient.row(k).transpose() - expected.gradient).norm() < 100.0 * rounding);
        CHECK(model.leave_one_out().col(k) == one.leave_one_out());
    }
}

TEST_CASE("CoefficientModel: interpolates, and its gradient is that of its values", "[rom]") {
    // Lengths at which K is far from singular.
    const KrigingParameters parameters{VectorX::Constant(3, 0.5), 0.0};
    const CoefficientModel model(tensor_design(), training(tensor_design()), {.nugget = 0.0},
                                 {parameters, parameters, parameters});
    const MatrixX points = tensor_design().points();
    for (const int i : {0, 7, 20}) {
        CHECK((model.values(points.row(i)) - training(tensor_design()).row(i).transpose()).norm() <
              1e-6);
    }
    constexpr double step = 1e-5;
    const MatrixX gradient = model.gradient(somewhere);
    for (int i = 0; i < 3; ++i) {
        const VectorX e = step * VectorX::Unit(3, i);
        const VectorX slope =
            (model.values(somewhere + e) - model.values(somewhere - e)) / (2.0 * step);
        CHECK((gradient.col(i) - slope).norm() < 1e-6);
    }
}

TEST_CASE("CoefficientModel: leave-one-out errors have the variances expected of them", "[rom]") {
    // A model fitted without a point: its error there, and its own variance there.
    const TensorDesign design{{latin_hypercube_design(3, 20, 1)}};
    const CoefficientModel model(design, training(design), {.nugget = 0.0});
    const int left_out = 6;
    std::vector<int> others;
    for (int i = 0; i < 20; ++i) {
        if (i != left_out) {
            others.push_back(i);
        }
    }
    const TensorDesign fewer{{design.points()(others, Eigen::all)}};
    for (int k = 0; k < 3; ++k) {
        const Kriging one(fewer, training(design)(others, k), {.nugget = 0.0},
                          model.parameters()[k]);
        const Kriging all(design, training(design).col(k), {.nugget = 0.0}, model.parameters()[k]);
        const Prediction there = one.predict(design.points().row(left_out));
        CHECK(training(design)(left_out, k) - there.value ==
              Approx(model.leave_one_out()(left_out, k)).epsilon(1e-6));
        // The process variance is that of all points: compare variances over it.
        const double scale =
            all.variance(VectorX::Constant(3, 100.0)) / one.variance(VectorX::Constant(3, 100.0));
        CHECK(model.leave_one_out_variances()(left_out, k) ==
              Approx(there.variance * scale).epsilon(0.2));
    }
}

TEST_CASE("CoefficientModel: known parameters give the same model", "[rom]") {
    const CoefficientModel model(tensor_design(), training(tensor_design()), {});
    const CoefficientModel again(model.design(), model.training(), model.options(),
                                 model.parameters());
    CHECK(again.values(somewhere) == model.values(somewhere));
    CHECK(again.variances(somewhere) == model.variances(somewhere));
    CHECK_THROWS_WITH(CoefficientModel(model.design(), model.training(), {}, {}),
                      Catch::Contains("0 kriging parameters for 3 coefficients"));
}

TEST_CASE("CoefficientModel: names the coefficient that can't be learned", "[rom]") {
    MatrixX values = training(tensor_design());
    values(3, 1) = std::numeric_limits<double>::infinity();
    CHECK_THROWS_WITH(CoefficientModel(tensor_design(), values, {}),
                      Catch::Contains("coefficient 1: Kriging: a value is not finite"));
}

TEST_CASE("CoefficientModel: an automatic trend is that of the largest coefficient", "[rom]") {
    const MatrixX points = latin_hypercube_design(2, 20, 5);
    const VectorX x = points.col(0);
    const VectorX y = points.col(1);
    MatrixX values(20, 1);
    values.col(0) = 1.0 + x.array() - 3.0 * x.array() * y.array() + y.array().square();
    const KrigingOptions options{.trend = Trend::automatic};
    CHECK(CoefficientModel({{points}}, values, options).options().trend == Trend::quadratic);
    // Too few points for more terms than one.
    const CoefficientModel few({{points.topRows(3)}}, values.topRows(3), options);
    CHECK(few.options().trend == Trend::constant);
}
