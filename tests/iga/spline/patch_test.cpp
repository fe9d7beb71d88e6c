#include "iga/spline/patch.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numbers>

#include "iga/core/error.h"
#include "iga/spline/shapes.h"

using namespace couture;
using namespace couture::iga;

namespace {

constexpr double rounding = 1e-13;

template <int d>
TensorSpace<d> mixed_space() {
    // Degrees 2, 3, 1 with a double, a simple and a simple interior knot.
    const KnotVector first(2, {0, 0, 0, 0.4, 0.4, 1, 1, 1});
    const KnotVector second(3, {-1, -1, -1, -1, 0.5, 2, 2, 2, 2});
    const KnotVector third(1, {0, 0, 0.3, 1, 1});
    if constexpr (d == 1) {
        return {{first}};
    } else if constexpr (d == 2) {
        return {{first, second}};
    } else {
        return {{first, second, third}};
    }
}

/// A curved patch; its weights range from 0.6 to 1.4.
template <int d>
Patch<d> make_curved(bool is_rational, int dimension = 3) {
    const TensorSpace<d> space = mixed_space<d>();
    MatrixX points(space.n_basis(), dimension);
    VectorX weights(space.n_basis());
    for (int i = 0; i < space.n_basis(); ++i) {
        for (int a = 0; a < dimension; ++a) {
            points(i, a) = std::sin(1.3 * i + 2.1 * a) + 0.1 * i;
        }
        weights[i] = 1.0 + 0.4 * std::sin(3.7 * i);
    }
    return {space, points, is_rational ? weights : VectorX{}};
}

template <int d>
std::vector<Vector<d>> sample_parameters() {
    std::vector<Vector<d>> result;
    for (const double t : {0.11, 0.37, 0.62, 0.93}) {
        Vector<d> xi;
        for (int k = 0; k < d; ++k) {
            const KnotVector knots = mixed_space<d>().knots[k];
            const double s = std::fmod(t + 0.23 * k, 1.0);
            xi[k] = (1.0 - s) * knots.front() + s * knots.back();
        }
        result.push_back(xi);
    }
    return result;
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("Patch: the Jacobian is the difference quotient of the point", "[spline]",
                       ((int d), d), 1, 2, 3) {
    const Patch<d> patch = make_curved<d>(GENERATE(false, true));
    constexpr double step = 1e-5;
    constexpr double difference_error = 1e-7;
    for (const Vector<d>& xi : sample_parameters<d>()) {
        const MatrixX J = patch.jacobian(xi);
        REQUIRE(J.rows() == 3);
        REQUIRE(J.cols() == d);
        for (int k = 0; k < d; ++k) {
            const Vector<d> e = step * Vector<d>::Unit(k);
            const VectorX quotient = (patch.point(xi + e) - patch.point(xi - e)) / (2.0 * step);
            CHECK((quotient - J.col(k)).norm() < difference_error * (1.0 + J.norm()));
        }
    }
}

TEMPLATE_TEST_CASE_SIG("evaluate_basis: rational functions sum to one, their gradients to zero",
                       "[spline]", ((int d), d), 1, 2, 3) {
    const Patch<d> patch = make_curved<d>(GENERATE(false, true));
    for (const Vector<d>& xi : sample_parameters<d>()) {
        const PointBasis<d> basis = evaluate_basis(patch.space(), patch.weights(), xi);
        CHECK(std::abs(basis.values.sum() - 1.0) < rounding);
        CHECK(basis.values.minCoeff() >= 0.0);
        CHECK(basis.gradients.colwise().sum().norm() < 10.0 * rounding * basis.gradients.norm());
    }
}

TEMPLATE_TEST_CASE_SIG("Patch: an affine map of the control points maps the points", "[spline]",
                       ((int d), d), 1, 2, 3) {
    const Patch<d> patch = make_curved<d>(true);
    Matrix<3> A;
    A << 1.0, 0.3, -0.2, 0.5, -2.0, 0.1, 0.0, 0.7, 1.5;
    const Vector3 shift(4.0, -5.0, 6.0);
    const MatrixX points = (patch.control_points() * A.transpose()).rowwise() + shift.transpose();
    const Patch<d> moved(patch.space(), points, patch.weights());
    for (const Vector<d>& xi : sample_parameters<d>()) {
        const VectorX expected = A * patch.point(xi) + shift;
        CHECK((moved.point(xi) - expected).norm() < 100.0 * rounding);
        const MatrixX expected_jacobian = A * patch.jacobian(xi);
        CHECK((moved.jacobian(xi) - expected_jacobian).norm() <
              100.0 * rounding * expected_jacobian.norm());
    }
}

TEMPLATE_TEST_CASE_SIG("Patch: homogeneous rows come back and are points times weights", "[spline]",
                       ((int d), d), 1, 2, 3) {
    const bool is_rational = GENERATE(false, true);
    const Patch<d> patch = make_curved<d>(is_rational);
    const MatrixX rows = patch.homogeneous();
    REQUIRE(rows.cols() == 4);
    for (Eigen::Index i = 0; i < rows.rows(); ++i) {
        const double weight = is_rational ? patch.weights()[i] : 1.0;
        CHECK(rows(i, 3) == weight);
        CHECK((rows.row(i).head(3) - weight * patch.control_points().row(i)).norm() < rounding);
    }
    const Patch<d> back = Patch<d>::from_homogeneous(patch.space(), rows, is_rational);
    CHECK(back.space() == patch.space());
    CHECK(back.is_rational() == is_rational);
    CHECK(back.weights() == patch.weights());
    CHECK((back.control_points() - patch.control_points()).norm() < rounding * rows.norm());
    // A common factor of all homogeneous rows changes no point.
    const Patch<d> scaled = Patch<d>::from_homogeneous(patch.space(), 8.0 * rows, true);
    CHECK(scaled.is_rational() == is_rational);
    for (const Vector<d>& xi : sample_parameters<d>()) {
        CHECK((scaled.point(xi) - patch.point(xi)).norm() < rounding * rows.norm());
    }
}

TEST_CASE("Patch: a rational quarter circle is round, a polynomial one is not", "[spline]") {
    const Curve arc = make_arc(2.0, 0.0, 0.5 * std::numbers::pi);
    const Curve parabola(arc.space(), arc.control_points());
    for (const double t : {0.0, 0.1, 0.25, 0.6, 1.0}) {
        const Vector<1> xi(t);
        const VectorX x = arc.point(xi);
        CHECK(std::abs(x.norm() - 2.0) < rounding);
        CHECK(std::abs(x.dot(arc.jacobian(xi).col(0))) < 10.0 * rounding);
    }
    CHECK(std::abs(parabola.point(Vector<1>(0.5)).norm() - 2.0) > 0.1);
}

TEST_CASE("Patch: corners are control points", "[spline]") {
    const Patch<3> patch = make_curved<3>(true);
    const auto& space = patch.space();
    for (int corner = 0; corner < 8; ++corner) {
        Vector3 xi;
        std::array<int, 3> index{};
        for (int k = 0; k < 3; ++k) {
            const bool is_high = (corner >> k & 1) == 1;
            xi[k] = is_high ? space.knots[k].back() : space.knots[k].front();
            index[k] = is_high ? space.knots[k].n_basis() - 1 : 0;
        }
        CHECK(
            (patch.point(xi) - patch.control_points().row(space.index(index)).transpose()).norm() <
            rounding);
    }
}

TEST_CASE("Patch: equal weights are dropped", "[spline]") {
    const Patch<2> patch = make_curved<2>(false);
    const Patch<2> weighted(patch.space(), patch.control_points(),
                            VectorX::Constant(patch.space().n_basis(), 0.7));
    CHECK_FALSE(weighted.is_rational());
    CHECK(weighted.point(Vector2(0.2, 0.3)) == patch.point(Vector2(0.2, 0.3)));
}

TEST_CASE("TensorSpace: numbers run with the first direction fastest", "[spline]") {
    const TensorSpace<3> space = mixed_space<3>();
    CHECK(space.sizes() == std::array<int, 3>{5, 5, 3});
    CHECK(space.degrees() == std::array<int, 3>{2, 3, 1});
    CHECK(space.n_elements() == std::array<int, 3>{2, 2, 2});
    CHECK(space.n_basis() == 75);
    CHECK(space.index({1, 2, 1}) == 1 + 5 * (2 + 5 * 1));
    for (int i = 0; i < space.n_basis(); ++i) {
        CHECK(space.index(space.indices(i)) == i);
    }
}

TEST_CASE("Patch: counts, numbers and weights that can't be are named", "[spline]") {
    const TensorSpace<2> space = {{KnotVector::uniform(1, 1), KnotVector::uniform(1, 1)}};
    MatrixX points(4, 2);
    points << 0, 0, 1, 0, 0, 1, 1, 1;
    CHECK_THROWS_AS(Patch<2>(space, points.topRows(3)), InputError);
    CHECK_THROWS_WITH(Patch<2>(space, points.topRows(3)),
                      "Patch: 3 control points; the knot vectors ask for 4");
    CHECK_THROWS_WITH(Patch<2>(space, points.leftCols(1)),
                      "Patch: control points have 1 coordinates; a patch with 2 parameters takes 2 "
                      "to 3");
    CHECK_THROWS_WITH(Patch<2>(space, MatrixX::Zero(4, 4)),
                      "Patch: control points have 4 coordinates; a patch with 2 parameters takes 2 "
                      "to 3");
    MatrixX broken = points;
    broken(2, 1) = std::numeric_limits<double>::infinity();
    CHECK_THROWS_WITH(Patch<2>(space, broken),
                      "Patch: control point 2 has a coordinate that is not finite");
    CHECK_THROWS_WITH(Patch<2>(space, points, VectorX::Ones(3)),
                      "Patch: 3 weights; the knot vectors ask for 4");
    VectorX weights = VectorX::Ones(4);
    weights[3] = 0.0;
    CHECK_THROWS_WITH(Patch<2>(space, points, weights),
                      "Patch: weight 3 = 0; weights must be positive");
    weights[3] = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_WITH(Patch<2>(space, points, weights),
                      "Patch: weight 3 = nan; weights must be positive");
    weights[3] = std::numeric_limits<double>::infinity();
    CHECK_THROWS_WITH(Patch<2>(space, points, weights),
                      "Patch: weight 3 = inf; weights must be positive");
    CHECK_THROWS_WITH(Patch<2>(space, points).point(Vector2(0.5, 1.01)),
                      "KnotVector: parameter 1.01 lies outside [0, 1]");
}
