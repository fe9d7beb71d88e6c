#include "iga/spline/bspline_basis.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "iga/core/error.h"
#include "iga/spline/gauss.h"

using namespace couture;
using namespace couture::iga;

namespace {

/// Sums of a few hundred roundings.
constexpr double rounding = 1e-13;

/// Uneven elements; interior knots of multiplicity 1, 2, .., degree.
KnotVector all_multiplicities(int degree) {
    std::vector<double> knots(degree + 1, -1.0);
    double knot = -1.0;
    for (int multiplicity = 1; multiplicity <= degree; ++multiplicity) {
        knot += multiplicity % 2 == 0 ? 0.7 : 1.2;
        knots.insert(knots.end(), multiplicity, knot);
    }
    knots.insert(knots.end(), degree + 1, knot + 0.9);
    return {degree, knots};
}

/// The recursion as it is defined, over half-open spans. Source: [PieglTiller97] Eq. (2.5).
double recursion(const std::vector<double>& knots, int i, int degree, double xi) {
    if (degree == 0) {
        return knots[i] <= xi && xi < knots[i + 1] ? 1.0 : 0.0;
    }
    double value = 0.0;
    if (knots[i + degree] > knots[i]) {
        value +=
            (xi - knots[i]) / (knots[i + degree] - knots[i]) * recursion(knots, i, degree - 1, xi);
    }
    if (knots[i + degree + 1] > knots[i + 1]) {
        value += (knots[i + degree + 1] - xi) / (knots[i + degree + 1] - knots[i + 1]) *
                 recursion(knots, i + 1, degree - 1, xi);
    }
    return value;
}

/// Rows of `basis_derivatives` spread over all functions.
MatrixX over_all_functions(const KnotVector& knots, int span, const MatrixX& rows) {
    MatrixX result = MatrixX::Zero(rows.rows(), knots.n_basis());
    result.middleCols(span - knots.degree(), knots.degree() + 1) = rows;
    return result;
}

/// Points strictly inside element `e`.
std::vector<double> points_inside(const KnotVector& knots, int e) {
    std::vector<double> points;
    for (const double t : {0.07, 0.31, 0.5, 0.88}) {
        points.push_back((1.0 - t) * knots.breakpoints()[e] + t * knots.breakpoints()[e + 1]);
    }
    return points;
}

}  // namespace

TEST_CASE("basis_derivatives: values are those of the recursion, with its local support",
          "[spline]") {
    const int degree = GENERATE(range(1, max_degree + 1));
    const KnotVector knots = all_multiplicities(degree);
    for (int e = 0; e < knots.n_elements(); ++e) {
        for (const double xi : points_inside(knots, e)) {
            const int span = knots.find_span(xi);
            const MatrixX N = over_all_functions(knots, span, basis_derivatives(knots, xi, 0));
            for (int i = 0; i < knots.n_basis(); ++i) {
                CHECK(std::abs(N(0, i) - recursion(knots.knots(), i, degree, xi)) < rounding);
                const bool is_supported =
                    knots.knots()[i] < xi && xi < knots.knots()[i + degree + 1];
                CHECK((N(0, i) > 0.0) == is_supported);
            }
        }
    }
}

TEST_CASE("basis_derivatives: values sum to one, derivatives to zero", "[spline]") {
    const int degree = GENERATE(range(1, max_degree + 1));
    const KnotVector knots = all_multiplicities(degree);
    std::vector<double> points = knots.breakpoints();
    for (int e = 0; e < knots.n_elements(); ++e) {
        const std::vector<double> inside = points_inside(knots, e);
        points.insert(points.end(), inside.begin(), inside.end());
    }
    for (const double xi : points) {
        const MatrixX rows = basis_derivatives(knots, xi, degree + 2);
        REQUIRE(rows.rows() == degree + 3);
        REQUIRE(rows.cols() == degree + 1);
        CHECK(std::abs(rows.row(0).sum() - 1.0) < rounding);
        for (int k = 1; k <= degree; ++k) {
            CHECK(std::abs(rows.row(k).sum()) < rounding * rows.row(k).lpNorm<1>());
        }
        CHECK(rows.row(degree).norm() > 0.0);
        CHECK(rows.bottomRows(2).isZero(0.0));
    }
}

TEST_CASE("basis_derivatives: each derivative is the difference quotient of the one below",
          "[spline]") {
    const int degree = GENERATE(range(1, max_degree + 1));
    const KnotVector knots = all_multiplicities(degree);
    // Central differences: error step^2 times the third derivative, rounding / step.
    constexpr double step = 1e-5;
    constexpr double difference_error = 1e-6;
    for (int e = 0; e < knots.n_elements(); ++e) {
        for (const double xi : points_inside(knots, e)) {
            const MatrixX rows = basis_derivatives(knots, xi, degree);
            const MatrixX after = basis_derivatives(knots, xi + step, degree);
            const MatrixX before = basis_derivatives(knots, xi - step, degree);
            for (int k = 1; k <= degree; ++k) {
                const VectorX quotient = (after.row(k - 1) - before.row(k - 1)) / (2.0 * step);
                const double scale =
                    1.0 + rows.bottomRows(degree + 1 - k).lpNorm<Eigen::Infinity>();
                CHECK((quotient - rows.row(k).transpose()).norm() < difference_error * scale);
            }
        }
    }
}

TEST_CASE("basis_derivatives: a knot of multiplicity m leaves degree - m continuous derivatives",
          "[spline]") {
    const int degree = GENERATE(range(1, max_degree + 1));
    const KnotVector knots = all_multiplicities(degree);
    for (int e = 1; e < knots.n_elements(); ++e) {
        const double xi = knots.breakpoints()[e];
        const int left = knots.span_of_element(e - 1);
        const int right = knots.span_of_element(e);
        const MatrixX jump =
            over_all_functions(knots, right, basis_derivatives(knots, right, xi, degree)) -
            over_all_functions(knots, left, basis_derivatives(knots, left, xi, degree));
        const MatrixX rows = basis_derivatives(knots, xi, degree);
        const int n_continuous = degree - knots.multiplicities()[e];
        for (int k = 0; k <= n_continuous; ++k) {
            CHECK(jump.row(k).norm() < 10.0 * rounding * (1.0 + rows.row(k).norm()));
        }
        // And not one more.
        CHECK(jump.row(n_continuous + 1).norm() > 0.01 * rows.row(n_continuous + 1).norm());
    }
}

TEST_CASE("basis_derivatives: the first and the last function are one at the ends", "[spline]") {
    const int degree = GENERATE(range(1, max_degree + 1));
    const KnotVector knots = all_multiplicities(degree);
    const MatrixX first = basis_derivatives(knots, knots.front(), 1);
    const MatrixX last = basis_derivatives(knots, knots.back(), 1);
    CHECK(first(0, 0) == 1.0);
    CHECK(last(0, degree) == 1.0);
    const double first_length = knots.breakpoints()[1] - knots.front();
    CHECK(first(1, 0) == Approx(-degree / first_length));
}

TEST_CASE("basis_derivatives: a parameter outside is refused", "[spline]") {
    const KnotVector knots = KnotVector::uniform(2, 3);
    CHECK_THROWS_AS(basis_derivatives(knots, 1.5, 1), InputError);
    CHECK_THROWS_WITH(basis_derivatives(knots, 1.5, 1),
                      "KnotVector: parameter 1.5 lies outside [0, 1]");
    CHECK_THROWS_WITH(basis_derivatives(knots, -0.25, 1),
                      "KnotVector: parameter -0.25 lies outside [0, 1]");
    CHECK_THROWS_WITH(basis_derivatives(knots, std::numeric_limits<double>::quiet_NaN(), 0),
                      "KnotVector: parameter nan lies outside [0, 1]");
}

TEST_CASE("tabulate: holds the functions at the points of each element of a finer grid",
          "[spline]") {
    const int degree = GENERATE(1, 2, 4);
    const KnotVector knots = all_multiplicities(degree);
    std::vector<double> breakpoints;
    for (int e = 0; e < knots.n_elements(); ++e) {
        const double first = knots.breakpoints()[e];
        breakpoints.push_back(first);
        breakpoints.push_back(first + 0.3 * (knots.breakpoints()[e + 1] - first));
    }
    breakpoints.push_back(knots.back());
    const std::vector<double>& points = gauss_rule(3).points;
    const BasisTable table = tabulate(knots, breakpoints, points);
    CHECK(table.n_points == 3);
    CHECK(table.n_functions == degree + 1);
    REQUIRE(table.first_function.size() == breakpoints.size() - 1);
    for (int e = 0; e + 1 < static_cast<int>(breakpoints.size()); ++e) {
        for (int q = 0; q < 3; ++q) {
            const double xi = breakpoints[e] + points[q] * (breakpoints[e + 1] - breakpoints[e]);
            CHECK(table.first_function[e] == knots.find_span(xi) - degree);
            const MatrixX rows = basis_derivatives(knots, xi, 1);
            for (int j = 0; j <= degree; ++j) {
                CHECK(std::abs(table.value(e, q)[j] - rows(0, j)) < rounding);
                CHECK(std::abs(table.derivative(e, q)[j] - rows(1, j)) < 10.0 * rounding);
            }
        }
    }
}

TEST_CASE("tabulate: an element across a knot is refused", "[spline]") {
    const KnotVector knots = KnotVector::uniform(2, 2);
    const std::vector<double> breakpoints = {0.0, 0.25, 1.0};
    const std::vector<double> points = {0.5};
    CHECK_THROWS_WITH(tabulate(knots, breakpoints, points),
                      "tabulate: element [0.25, 1] crosses a knot of span [0.5, 1]");
}
