#include "iga/spline/point_inversion.h"

#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "iga/core/error.h"
#include "iga/spline/refine.h"
#include "iga/spline/shapes.h"

using namespace couture;
using namespace couture::iga;
using std::numbers::pi;

namespace {

/// What the project asks of point inversion, relative to shapes of size one.
constexpr double found = 1e-10;
constexpr int n_points = 1000;
/// Fewer where one point is compared with thousands of samples or searches many cells.
constexpr int n_hard_points = 200;
/// Round trips of parameters lose digits by the condition of the Jacobian.
constexpr double same_parameter = 1e-8;

class Random {
  public:
    double operator()(double first, double last) {
        return std::uniform_real_distribution<double>(first, last)(generator_);
    }
    template <int n>
    Vector<n> vector(double first, double last) {
        Vector<n> result;
        for (int i = 0; i < n; ++i) {
            result[i] = (*this)(first, last);
        }
        return result;
    }

  private:
    std::mt19937 generator_{42};
};

/// Points of the patch come back with distance zero and, where `is_injective`, their parameter.
template <int d>
void check_round_trip(const Patch<d>& patch, bool is_injective) {
    const PointInversion<d> inversion(patch);
    Random random;
    double worst = 0.0;
    double worst_parameter = 0.0;
    for (int i = 0; i < n_points; ++i) {
        Vector<d> xi = random.vector<d>(0.0, 1.0);
        if (i % 10 == 0) {
            xi[i / 10 % d] = std::round(xi[i / 10 % d]);
        }
        const VectorX x = patch.point(xi);
        const InvertedPoint<d> result = inversion.nearest(x);
        worst = std::max({worst, result.distance, (patch.point(result.xi) - x).norm()});
        worst_parameter = std::max(worst_parameter, (result.xi - xi).norm());
    }
    CHECK(worst < found);
    if (is_injective) {
        CHECK(worst_parameter < same_parameter);
    }
}

/// No sample of a fine grid is nearer than the answer, and the answer is a point of the patch.
template <int d>
void check_against_samples(const Patch<d>& patch, double reach) {
    constexpr int n_grid = d == 1 ? 2000 : d == 2 ? 70 : 17;
    int n_samples = 1;
    for (int k = 0; k < d; ++k) {
        n_samples *= n_grid;
    }
    MatrixX samples(patch.dimension(), n_samples);
    for (int i = 0; i < n_samples; ++i) {
        Vector<d> xi;
        int rest = i;
        for (int k = 0; k < d; ++k) {
            xi[k] = static_cast<double>(rest % n_grid) / (n_grid - 1);
            rest /= n_grid;
        }
        samples.col(i) = patch.point(xi);
    }
    const PointInversion<d> inversion(patch);
    Random random;
    double worst = -1.0;
    double mismatch = 0.0;
    for (int i = 0; i < n_hard_points; ++i) {
        VectorX x(patch.dimension());
        for (double& coordinate : x) {
            coordinate = random(-reach, reach);
        }
        const InvertedPoint<d> result = inversion.nearest(x);
        const double sampled = (samples.colwise() - x).colwise().norm().minCoeff();
        worst = std::max(worst, result.distance / sampled - 1.0);
        mismatch =
            std::max(mismatch, std::abs((patch.point(result.xi) - x).norm() - result.distance));
    }
    CHECK(worst < found);
    CHECK(mismatch < found);
}

/// A B-spline patch with control points off the regular grid by up to `amplitude` spacings.
template <int d>
Patch<d> wavy_patch(int degree, int n_elements, int dimension, double amplitude) {
    const KnotVector knots = KnotVector::uniform(degree, n_elements);
    const TensorSpace<d> space = [&] {
        if constexpr (d == 1) {
            return TensorSpace<1>{{knots}};
        } else if constexpr (d == 2) {
            return TensorSpace<2>{{knots, knots}};
        } else {
            return TensorSpace<3>{{knots, knots, knots}};
        }
    }();
    Random random;
    const std::vector<double> greville = knots.greville();
    MatrixX points(space.n_basis(), dimension);
    VectorX weights(space.n_basis());
    for (int i = 0; i < space.n_basis(); ++i) {
        for (int c = 0; c < dimension; ++c) {
            points(i, c) = random(-amplitude, amplitude) / knots.n_basis() +
                           (c < d ? greville[space.indices(i)[c]] : 0.5);
        }
        weights[i] = random(0.5, 2.0);
    }
    return {space, points, weights};
}

Surface circular_sector() {
    const Curve arc = make_arc(1.0, 0.0, 1.5 * pi);
    const Curve center(arc.space(), MatrixX::Zero(arc.space().n_basis(), 2), arc.weights());
    return make_ruled(center, arc);
}

}  // namespace

TEST_CASE("PointInversion: points of the patch are found again", "[spline]") {
    check_round_trip<1>(make_arc(1.0, 0.3, 1.9 * pi), true);
    check_round_trip<2>(make_quarter_annulus(0.1, 1.0), true);
    check_round_trip<3>(
        make_revolution(
            make_multilinear<2>((MatrixX(4, 2) << 0.2, 0, 0.2, 1, 1, 0, 1, 1).finished()),
            1.9 * pi),
        true);
    for (int degree = 2; degree <= 5; ++degree) {
        check_round_trip<2>(wavy_patch<2>(degree, 4, 2, 0.25), true);
    }
    check_round_trip<1>(wavy_patch<1>(3, 6, 3, 2.0), true);
    check_round_trip<2>(wavy_patch<2>(4, 3, 3, 1.0), true);
    check_round_trip<3>(wavy_patch<3>(2, 2, 3, 0.15), true);
    check_round_trip<3>(wavy_patch<3>(3, 2, 3, 0.15), true);
}

TEST_CASE("PointInversion: left-handed patches are no exception", "[spline]") {
    const Surface annulus = make_quarter_annulus(0.5, 1.0);
    const Surface mirrored(annulus.space(), annulus.control_points().rowwise().reverse(),
                           annulus.weights());
    REQUIRE(mirrored.jacobian(Vector2(0.5, 0.5)).determinant() < 0.0);
    check_round_trip<2>(mirrored, true);
}

TEST_CASE("PointInversion: collapsed edges and folded patches are searched to the end",
          "[spline]") {
    check_round_trip<2>(circular_sector(), false);
    check_round_trip<3>(make_sphere_shell_patch(0.5, 1.0), false);
    check_round_trip<2>(wavy_patch<2>(3, 3, 2, 2.0), false);
    check_round_trip<3>(wavy_patch<3>(2, 2, 3, 1.5), false);

    // The map (s, t) -> (s^3, s^3 t) has no derivative at all at s = 0.
    const TensorSpace<2> space{{KnotVector::uniform(3, 1), KnotVector::uniform(1, 1)}};
    MatrixX points = MatrixX::Zero(8, 2);
    points.row(3) << 1.0, 0.0;
    points.row(7) << 1.0, 1.0;
    check_round_trip<2>(Surface(space, points), false);
}

TEST_CASE("PointInversion: no sample is nearer than the answer", "[spline]") {
    check_against_samples<1>(make_ellipse_arc(1.0, 0.1, 0.0, 2.0 * pi), 1.5);
    check_against_samples<1>(wavy_patch<1>(8, 1, 3, 30.0), 2.0);
    check_against_samples<1>(wavy_patch<1>(3, 20, 2, 5.0), 1.5);
    check_against_samples<2>(circular_sector(), 1.5);
    check_against_samples<2>(wavy_patch<2>(3, 3, 3, 2.0), 1.5);
    check_against_samples<2>(wavy_patch<2>(5, 1, 2, 2.0), 1.5);
    check_against_samples<3>(make_sphere_shell_patch(0.5, 1.0), 1.5);
    check_against_samples<3>(wavy_patch<3>(2, 2, 3, 0.5), 1.5);
    // A saddle: the distance to it has two valleys.
    check_against_samples<2>(
        make_multilinear<2>((MatrixX(4, 3) << 0, 0, 0, 1, 0, 1, 0, 1, 1, 1, 1, 0).finished()), 2.0);
}

TEST_CASE("PointInversion: distances to circles and spheres are the exact ones", "[spline]") {
    const PointInversion<1> circle(make_arc(2.0, 0.0, 2.0 * pi));
    const PointInversion<3> shell(make_sphere_shell_patch(1.0, 2.0));
    Random random;
    for (int i = 0; i < n_hard_points; ++i) {
        const Vector2 x = random.vector<2>(-5.0, 5.0);
        CHECK(std::abs(circle.nearest(x).distance - std::abs(x.norm() - 2.0)) < found);
        const Vector3 y = random.vector<3>(0.0, 4.0);
        const double outside = std::max({0.0, y.norm() - 2.0, 1.0 - y.norm()});
        CHECK(std::abs(shell.nearest(y).distance - outside) < found);
    }
    CHECK(circle.nearest(Vector2::Zero()).distance == Approx(2.0).epsilon(found));
}

TEST_CASE("PointInversion: find keeps to its tolerance", "[spline]") {
    const PointInversion<2> inversion(make_box<2>(Vector2(1.0, 1.0)));
    const auto inside = inversion.find(Vector2(0.25, 0.75), 1e-12);
    REQUIRE(inside);
    CHECK((*inside - Vector2(0.25, 0.75)).norm() < found);
    CHECK(inversion.find(Vector2(1.05, 0.5), 0.1));
    CHECK_FALSE(inversion.find(Vector2(1.05, 0.5), 0.01));
    CHECK((*inversion.find(Vector2(1.05, 1.05), 0.1) - Vector2(1.0, 1.0)).norm() == 0.0);
}

TEST_CASE("PointInversion: points of another kind are refused", "[spline]") {
    const PointInversion<2> inversion(make_box<2>(Vector2(1.0, 1.0)));
    CHECK_THROWS_WITH(inversion.nearest(Vector3::Zero()),
                      "PointInversion: point of 3 coordinates; the patch has 2");
    CHECK_THROWS_WITH(inversion.nearest(Vector2(0.0, std::numeric_limits<double>::infinity())),
                      "PointInversion: the point has a coordinate that is not finite");
}
