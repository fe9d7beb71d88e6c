#include "rom/kriging.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "iga/core/error.h"
#include "rom/designs.h"

using namespace couture;
using namespace couture::rom;

namespace {

constexpr double pi = std::numbers::pi;

template <typename F>
VectorX values_at(const MatrixX& points, F function) {
    VectorX values(points.rows());
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
        values[i] = function(VectorX(points.row(i).transpose()));
    }
    return values;
}

double smooth(const VectorX& x) {
    double sum = 2.0;
    for (Eigen::Index i = 0; i < x.size(); ++i) {
        sum += std::sin((1.0 + static_cast<double>(i)) * x[i]) * (1.0 + x[0]);
    }
    return sum;
}

/// Branin on [-5, 10] x [0, 15].
double branin(const VectorX& unit) {
    const double x = 15.0 * unit[0] - 5.0;
    const double y = 15.0 * unit[1];
    const double a = y - 5.1 / (4.0 * pi * pi) * x * x + 5.0 / pi * x - 6.0;
    return a * a + 10.0 * (1.0 - 1.0 / (8.0 * pi)) * std::cos(x) + 10.0;
}

/// Ishigami on [-pi, pi]^3 with a = 7, b = 0.1.
double ishigami(const VectorX& unit) {
    const VectorX x = (unit.array() - 0.5) * 2.0 * pi;
    return std::sin(x[0]) + 7.0 * std::pow(std::sin(x[1]), 2) +
           0.1 * std::pow(x[2], 4) * std::sin(x[0]);
}

/// Share of the variance at independent points that the model explains.
template <typename F>
double q2(const Kriging& model, F function, int n_parameters) {
    const MatrixX points = random_design(n_parameters, 2000, 77);
    const VectorX exact = values_at(points, function);
    const VectorX found = values_at(points, [&](const VectorX& x) { return model.value(x); });
    return 1.0 - (exact - found).squaredNorm() / (exact.array() - exact.mean()).square().sum();
}

TensorDesign scattered(int n_parameters, int n_points) {
    return {{latin_hypercube_design(n_parameters, n_points, 5)}};
}

TensorDesign two_factors() { return {{latin_hypercube_design(2, 8, 5), full_design(1, 4)}}; }

}  // namespace

TEST_CASE("Kriging: interpolates without nugget, with no variance at the data", "[rom]") {
    const TensorDesign design = GENERATE(scattered(3, 20), two_factors());
    const VectorX values = values_at(design.points(), smooth);
    const Kriging model(design, values, {.nugget = 0.0});
    const MatrixX points = design.points();
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
        const Prediction prediction = model.predict(points.row(i).transpose());
        CHECK(prediction.value == Approx(values[i]).margin(1e-7));
        CHECK(prediction.variance < 1e-7);
    }
}

TEST_CASE("Kriging: gradient of the prediction agrees with differences", "[rom]") {
    const TensorDesign design = GENERATE(scattered(3, 20), two_factors());
    const auto kind = GENERATE(CorrelationKind::gaussian, CorrelationKind::matern_5_2);
    const auto trend = GENERATE(Trend::constant, Trend::linear, Trend::quadratic);
    const VectorX values = values_at(design.points(), smooth);
    const Kriging model(design, values, {.correlation = kind, .trend = trend, .nugget = 1e-6});
    const VectorX x = (VectorX(3) << 0.3, 0.62, 0.81).finished();
    const Prediction prediction = model.predict(x);
    CHECK(model.value(x) == Approx(prediction.value));
    const double h = 1e-5;
    for (int i = 0; i < 3; ++i) {
        const VectorX step = h * VectorX::Unit(3, i);
        CHECK(prediction.gradient[i] ==
              Approx((model.value(x + step) - model.value(x - step)) / (2.0 * h)).epsilon(1e-5));
    }
}

TEST_CASE("kriging_objective: gradient agrees with differences", "[rom]") {
    const TensorDesign design = GENERATE(scattered(3, 15), two_factors());
    const auto kind = GENERATE(CorrelationKind::gaussian, CorrelationKind::matern_5_2);
    const auto trend = GENERATE(Trend::constant, Trend::linear, Trend::quadratic);
    const KrigingOptions options{.correlation = kind, .trend = trend};
    const VectorX values = values_at(design.points(), smooth);
    const VectorX x =
        (VectorX(4) << std::log(0.3), std::log(0.8), std::log(0.5), std::log(1e-3)).finished();
    VectorX gradient;
    VectorX unused;
    REQUIRE(std::isfinite(kriging_objective(design, values, options, x, gradient)));
    REQUIRE(gradient.size() == 4);
    const double h = 1e-5;
    for (int i = 0; i < 4; ++i) {
        const VectorX step = h * VectorX::Unit(4, i);
        const double difference = (kriging_objective(design, values, options, x + step, unused) -
                                   kriging_objective(design, values, options, x - step, unused)) /
                                  (2.0 * h);
        CHECK(gradient[i] == Approx(difference).epsilon(1e-5).margin(1e-6));
    }
}

TEST_CASE("Kriging: tensor designs give what the dense matrix gives", "[rom]") {
    const TensorDesign design = two_factors();
    const TensorDesign dense{{design.points()}};
    const VectorX values = values_at(design.points(), smooth);
    const double nugget = GENERATE(0.0, 1e-4);
    const KrigingParameters parameters{(VectorX(3) << 0.4, 0.6, 0.8).finished(), nugget};
    const KrigingOptions options{.nugget = nugget};
    const Kriging a(design, values, options, parameters);
    const Kriging b(dense, values, options, parameters);
    const VectorX x = (VectorX(3) << 0.3, 0.62, 0.81).finished();
    CHECK(a.predict(x).value == Approx(b.predict(x).value));
    CHECK(a.predict(x).variance == Approx(b.predict(x).variance).epsilon(1e-6));
    CHECK((a.predict(x).gradient - b.predict(x).gradient).norm() < 1e-6);
    CHECK((a.leave_one_out() - b.leave_one_out()).norm() < 1e-6);
}

TEST_CASE("Kriging: leave-one-out residuals are those of refitting", "[rom]") {
    const auto trend = GENERATE(Trend::constant, Trend::linear, Trend::quadratic);
    const MatrixX points = latin_hypercube_design(2, 14, 5);
    const VectorX values = values_at(points, smooth);
    const KrigingParameters parameters{Vector2(0.5, 0.7), 1e-5};
    const KrigingOptions options{.trend = trend, .nugget = 1e-5};
    const VectorX residuals = Kriging({{points}}, values, options, parameters).leave_one_out();
    for (int left_out = 0; left_out < 14; ++left_out) {
        MatrixX rest(13, 2);
        VectorX rest_values(13);
        for (int i = 0, row = 0; i < 14; ++i) {
            if (i != left_out) {
                rest.row(row) = points.row(i);
                rest_values[row++] = values[i];
            }
        }
        const Kriging refitted({{rest}}, rest_values, options, parameters);
        CHECK(residuals[left_out] ==
              Approx(values[left_out] - refitted.value(points.row(left_out).transpose()))
                  .epsilon(1e-6));
    }
}

TEST_CASE("Kriging: a quadratic trend gives back a paraboloid, far outside too", "[rom]") {
    const auto paraboloid = [](const VectorX& x) {
        return 2.0 - x[0] + 3.0 * x[1] + x[0] * x[1] - 0.5 * x[1] * x[1];
    };
    const TensorDesign design = scattered(2, 15);
    const Kriging model(design, values_at(design.points(), paraboloid),
                        {.trend = Trend::quadratic});
    const VectorX x = Vector2(3.0, -2.0);
    CHECK(model.value(x) == Approx(paraboloid(x)).epsilon(1e-6));
}

TEST_CASE("Kriging: trends leave out what a design can't tell apart", "[rom]") {
    // Along the axes no two inputs vary together; the last one has two levels, its square is
    // itself.
    const MatrixX star = star_design(3, 2);
    const MatrixX levels{{0.0}, {1.0}};
    const TensorDesign design{{star, levels}};
    const MatrixX points = design.points();
    CHECK(n_trend_functions(Trend::quadratic, 4) == 15);
    // 1, four inputs, three squares, and products of the last with the other three.
    CHECK(n_independent_terms(points, Trend::quadratic) == 11);
    const auto paraboloid = [](const VectorX& x) {
        return 1.0 + x[0] - 2.0 * x[1] * x[1] + 3.0 * x[2] * x[2] + x[3] - x[0] * x[3];
    };
    VectorX values(points.rows());
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
        values[i] = paraboloid(points.row(i).transpose());
    }
    const Kriging model(design, values, {.trend = Trend::quadratic});
    for (const VectorX& x : {VectorX{{0.1, 0.5, 0.5, 0.3}}, VectorX{{0.2, 0.9, 0.7, 0.8}},
                             VectorX{{-0.5, 1.5, 0.5, 0.0}}}) {
        CHECK(model.value(x) == Approx(paraboloid(x)).epsilon(1e-6));
        CHECK(std::isfinite(model.variance(x)));
        CHECK(model.variance(x) < 1e-6);
    }
    CHECK(model.leave_one_out().cwiseAbs().maxCoeff() < 1e-6);
    // An input that never varies has no slope.
    MatrixX flat = latin_hypercube_design(2, 12, 1);
    flat.col(1).setConstant(0.5);
    const Kriging line({{flat}}, flat.col(0), {.trend = Trend::linear});
    CHECK(line.value(VectorX{{0.3, 0.9}}) == Approx(0.3).epsilon(1e-6));
}

TEST_CASE("Kriging: a linear trend gives back a plane, far outside too", "[rom]") {
    const TensorDesign design = scattered(2, 12);
    const VectorX values =
        values_at(design.points(), [](const VectorX& x) { return 3.0 - 2.0 * x[0] + 5.0 * x[1]; });
    const Kriging model(design, values, {.trend = Trend::linear});
    CHECK(model.value(Vector2(2.0, -1.0)) == Approx(-6.0).epsilon(1e-6));
}

TEST_CASE("Kriging: known functions", "[rom]") {
    const TensorDesign square = scattered(2, 40);
    const Kriging of_branin(square, values_at(square.points(), branin));
    CHECK(q2(of_branin, branin, 2) > 0.995);

    const TensorDesign cube = scattered(3, 150);
    const Kriging of_ishigami(cube, values_at(cube.points(), ishigami));
    CHECK(q2(of_ishigami, ishigami, 3) > 0.97);
}

TEST_CASE("Kriging: more data leave less error", "[rom]") {
    const auto error = [](int n) {
        const TensorDesign design = scattered(2, n);
        const Kriging model(design, values_at(design.points(), branin));
        return 1.0 - q2(model, branin, 2);
    };
    CHECK(error(60) < 0.2 * error(20));
}

TEST_CASE("Kriging: the likelihood finds noise", "[rom]") {
    const TensorDesign design = scattered(2, 80);
    const MatrixX noise = random_design(1, 80, 9).array() - 0.5;
    const VectorX clean = values_at(design.points(), smooth);
    const Kriging model(design, clean + 0.2 * noise.col(0));
    CHECK(model.parameters().nugget > 1e-4);
    CHECK(Kriging(design, clean).parameters().nugget < 1e-6);
}

TEST_CASE("Kriging: constant values", "[rom]") {
    const TensorDesign design = scattered(2, 10);
    const Kriging model(design, VectorX::Constant(10, 4.0));
    CHECK(model.value(Vector2(0.3, 0.4)) == Approx(4.0));
    CHECK(model.predict(Vector2(0.3, 0.4)).variance < 1e-12);
}

TEST_CASE("Kriging: refuses data that fix no model", "[rom]") {
    const TensorDesign design = scattered(2, 10);
    CHECK_THROWS_WITH(Kriging(design, VectorX::Ones(9)),
                      Catch::Contains("9 values for a design of 10 points"));
    VectorX values = VectorX::Ones(10);
    values[3] = std::nan("");
    CHECK_THROWS_WITH(Kriging(design, values), Catch::Contains("not finite"));
    CHECK_THROWS_WITH(Kriging(scattered(4, 5), VectorX::Ones(5), {.trend = Trend::linear}),
                      Catch::Contains("needs at least 6"));
    MatrixX twice = design.factors[0];
    twice.row(9) = twice.row(0);
    CHECK_THROWS_WITH(Kriging({{twice}}, VectorX::Ones(10), {.nugget = 0.0}),
                      Catch::Contains("points coincide"));
}
