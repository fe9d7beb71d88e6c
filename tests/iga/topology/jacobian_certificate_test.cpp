#include "iga/topology/jacobian_certificate.h"

#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <functional>
#include <random>

#include "iga/core/error.h"
#include "iga/spline/bspline_basis.h"
#include "iga/spline/refine.h"
#include "iga/spline/shapes.h"

using namespace couture;
using namespace couture::iga;

namespace {

/// det J of a few hundred operations on numbers of order 1.
constexpr double rounding = 1e-12;

/// The Bezier patch that is a polynomial map (interpolated at Greville points: exact).
template <int d>
Patch<d> polynomial_patch(const std::array<int, d>& degrees,
                          const std::function<Vector<d>(const Vector<d>&)>& map) {
    std::vector<KnotVector> knots;
    for (const int degree : degrees) {
        knots.push_back(KnotVector::uniform(degree, 1));
    }
    TensorSpace<d> space = [&] {
        if constexpr (d == 2) {
            return TensorSpace<2>{{knots[0], knots[1]}};
        } else {
            return TensorSpace<3>{{knots[0], knots[1], knots[2]}};
        }
    }();
    const int n = space.n_basis();
    MatrixX N = MatrixX::Zero(n, n);
    MatrixX values(n, d);
    for (int i = 0; i < n; ++i) {
        Vector<d> xi;
        for (int k = 0; k < d; ++k) {
            xi[k] = knots[k].greville()[space.indices(i)[k]];
        }
        const PointBasis<d> basis = evaluate_basis<d>(space, {}, xi);
        for (std::size_t j = 0; j < basis.functions.size(); ++j) {
            N(i, basis.functions[j]) = basis.values[static_cast<int>(j)];
        }
        values.row(i) = map(xi).transpose();
    }
    return Patch<d>(space, N.partialPivLu().solve(values));
}

template <int d>
Patch<d> refined(const Patch<d>& patch, int n_elements) {
    if constexpr (d == 2) {
        return refine<2>(patch, {refine(patch.knots(0), patch.knots(0).degree(), n_elements),
                                 refine(patch.knots(1), patch.knots(1).degree(), n_elements)});
    } else {
        return refine<3>(patch, {refine(patch.knots(0), patch.knots(0).degree(), n_elements),
                                 refine(patch.knots(1), patch.knots(1).degree(), n_elements),
                                 refine(patch.knots(2), patch.knots(2).degree(), n_elements)});
    }
}

template <int d>
Patch<d> mirrored(const Patch<d>& patch) {
    MatrixX points = patch.control_points();
    points.col(0) *= -1.0;
    return Patch<d>(patch.space(), points, patch.weights());
}

template <int d>
double det_at(const Patch<d>& patch, const Vector<d>& xi) {
    return Matrix<d>(patch.jacobian(xi)).determinant();
}

/// Map with det J = |xi - centre|^2 - excess: folded in a small disc (ball) if excess > 0.
template <int d>
Patch<d> dimple(double excess) {
    std::array<int, d> degrees;
    degrees.fill(2);
    degrees[d - 1] = 3;
    return polynomial_patch<d>(degrees, [=](const Vector<d>& xi) {
        const double centre[3] = {0.37, 0.61, 0.55};
        Vector<d> x = xi;
        double squares = 0.0;
        for (int k = 0; k < d - 1; ++k) {
            squares += std::pow(xi[k] - centre[k], 2);
        }
        const double t = xi[d - 1] - centre[d - 1];
        x[d - 1] = squares * t + t * t * t / 3.0 - excess * t;
        return x;
    });
}

}  // namespace

TEST_CASE("certify: a box has constant det J", "[topology]") {
    const PatchCertificate<3> box = certify(make_box<3>(Vector3(2.0, 3.0, 0.5)));
    CHECK(box.validity == Validity::valid);
    CHECK(box.orientation == 1);
    CHECK(box.min_coefficient == Approx(3.0));
    CHECK(box.min_jacobian == Approx(3.0));
    const PatchCertificate<2> left = certify(mirrored(refined(make_box<2>(Vector2(2.0, 3.0)), 4)));
    CHECK(left.validity == Validity::valid);
    CHECK(left.orientation == -1);
    CHECK(left.min_coefficient == Approx(6.0));
}

TEST_CASE("certify: the lower bound is exact for a monotone det J", "[topology]") {
    // x = u - a u^2: det J = 1 - 2 a u, smallest at u = 1.
    const double a = GENERATE(0.3, 0.49, 0.51);
    const Patch<2> patch = polynomial_patch<2>(
        {2, 1}, [=](const Vector2& u) { return Vector2(u[0] - a * u[0] * u[0], u[1]); });
    for (const Patch<2>& same : {patch, refined(patch, 5)}) {
        const PatchCertificate<2> certificate = certify(same);
        CHECK(certificate.validity == (a < 0.5 ? Validity::valid : Validity::folded));
        CHECK(certificate.min_coefficient == Approx(1.0 - 2.0 * a));
        CHECK(certificate.min_jacobian == Approx(1.0 - 2.0 * a));
        CHECK(certificate.min_xi[0] == Approx(1.0));
    }
}

TEMPLATE_TEST_CASE_SIG("certify: tiny folds inside are found, near-folds proven valid",
                       "[topology]", ((int d), d), 2, 3) {
    // A disc of radius 0.03 without element corners in it.
    const PatchCertificate<d> folded = certify(dimple<d>(1e-3));
    CHECK(folded.validity == Validity::folded);
    CHECK(folded.min_jacobian < 0.0);
    CHECK(det_at<d>(dimple<d>(1e-3), folded.min_xi) ==
          Approx(folded.min_jacobian).margin(rounding));
    const Patch<d> near = dimple<d>(-0.02);
    const PatchCertificate<d> proven = certify(near);
    CHECK(proven.validity == Validity::valid);
    CHECK(proven.min_coefficient > 0.0);
    CHECK(proven.min_coefficient <= 0.02);
    CHECK(proven.min_jacobian >= 0.02 - rounding);
    // The coefficients of the whole element are not all positive.
    CHECK(certify(near, 0).validity == Validity::undecided);
}

TEMPLATE_TEST_CASE_SIG("certify: random B-spline and NURBS patches against pointwise det J",
                       "[topology]", ((int d), d), 2, 3) {
    const bool is_rational = GENERATE(false, true);
    const double noise = GENERATE(0.02, 0.3);
    std::mt19937 generator(4);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    const Patch<d> box = [&] {
        if constexpr (d == 2) {
            const Patch<2> unit = make_box<2>(Vector2(2.0, 1.0));
            return refine<2>(unit, {refine(unit.knots(0), 2, 3), refine(unit.knots(1), 3, 2)});
        } else {
            const Patch<3> unit = make_box<3>(Vector3(2.0, 1.0, 1.0));
            return refine<3>(unit, {refine(unit.knots(0), 2, 2), refine(unit.knots(1), 3, 2),
                                    refine(unit.knots(2), 2, 1)});
        }
    }();
    MatrixX points = box.control_points();
    VectorX weights = VectorX::Ones(points.rows());
    for (int i = 0; i < points.rows(); ++i) {
        for (int k = 0; k < d; ++k) {
            points(i, k) += 10.0 + noise * uniform(generator);
        }
        weights[i] += 0.3 * uniform(generator);
    }
    const Patch<d> patch(box.space(), points, is_rational ? 3.0 * weights : VectorX());
    const PatchCertificate<d> certificate = certify(patch);
    CHECK(certificate.orientation == 1);
    CHECK(certificate.validity == (noise < 0.1 ? Validity::valid : Validity::folded));
    CHECK(det_at<d>(patch, certificate.min_xi) == Approx(certificate.min_jacobian).epsilon(1e-9));
    for (int i = 0; i < 200; ++i) {
        Vector<d> xi;
        for (int k = 0; k < d; ++k) {
            xi[k] = 0.5 + 0.5 * uniform(generator);
        }
        double value = det_at<d>(patch, xi);
        if (is_rational) {
            const VectorX ones = VectorX::Ones(points.rows());
            double weight = 0.0;
            const PointBasis<d> basis = evaluate_basis<d>(patch.space(), {}, xi);
            for (std::size_t j = 0; j < basis.functions.size(); ++j) {
                weight += basis.values[static_cast<int>(j)] * 3.0 * weights[basis.functions[j]];
            }
            value *= std::pow(weight, d + 1);
        }
        CHECK(certificate.min_coefficient <= value + rounding);
    }
}

TEST_CASE("certify: the quarter annulus and the spherical shell", "[topology]") {
    const Surface annulus = make_quarter_annulus(1.0, 2.0);
    const PatchCertificate<2> flat = certify(annulus);
    CHECK(flat.validity == Validity::valid);
    CHECK(flat.min_jacobian == Approx(std::abs(det_at<2>(annulus, flat.min_xi))));
    const Volume shell = make_sphere_shell_patch(1.0, 2.0);
    for (const Volume& volume : {shell, refined(shell, 3)}) {
        const PatchCertificate<3> pole = certify(volume);
        CHECK(pole.validity == Validity::degenerate);
        CHECK(pole.orientation == 1);
        CHECK(pole.min_jacobian == Approx(0.0).margin(rounding));
    }
    CHECK(certify(mirrored(shell)).orientation == -1);
    CHECK(certify(mirrored(shell)).validity == Validity::degenerate);
}

TEST_CASE("certify: collapsed sides are degenerate, not folded", "[topology]") {
    // Quarter disc in polar form: the inner circle has radius 0.
    const Curve arc = make_arc(1.0, 0.0, 1.5);
    const Curve centre(arc.space(), MatrixX::Zero(3, arc.dimension()), arc.weights());
    const Surface polar = make_ruled(centre, arc);
    const Surface disc(polar.space(), polar.control_points().leftCols(2), polar.weights());
    CHECK(certify(disc).validity == Validity::degenerate);
    CHECK(certify(refined(disc, 4)).validity == Validity::degenerate);
    // A wedge: the side x = 1 of the cube shrinks to an edge.
    MatrixX corners = make_box<3>(Vector3(1.0, 1.0, 1.0)).control_points();
    for (int i = 0; i < 8; ++i) {
        corners(i, 1) *= corners(i, 0) == 1.0 ? 0.0 : 1.0;
    }
    CHECK(certify(make_multilinear<3>(corners)).validity == Validity::degenerate);
    CHECK(certify(refined(make_multilinear<3>(corners), 3)).validity == Validity::degenerate);
    // Beyond the edge: turned over.
    for (int i = 0; i < 8; ++i) {
        corners(i, 1) -= corners(i, 0) == 1.0 ? 0.1 * static_cast<double>(i / 2 % 2) : 0.0;
    }
    CHECK(certify(make_multilinear<3>(corners)).validity == Validity::folded);
}

TEST_CASE("certify: the four-sided disc is singular at its corners only", "[topology]") {
    const double h = std::sqrt(0.5);
    MatrixX points(9, 2);
    points << -h, -h, 0, -2 * h, h, -h, -2 * h, 0, 0, 0, 2 * h, 0, -h, h, 0, 2 * h, h, h;
    VectorX weights(9);
    weights << 1, h, 1, h, 1, h, 1, h, 1;
    const KnotVector knots = KnotVector::uniform(2, 1);
    const Surface disc({{knots, knots}}, points, weights);
    CHECK(certify(disc).validity == Validity::degenerate);
    CHECK(certify(refined(disc, 4)).validity == Validity::degenerate);
}

TEST_CASE("certify: a singular line inside is not accepted", "[topology]") {
    // x = (u - 1/2)^3: det J = 3 (u - 1/2)^2.
    const Patch<2> patch = polynomial_patch<2>(
        {3, 1}, [](const Vector2& u) { return Vector2(std::pow(u[0] - 0.5, 3), u[1]); });
    CHECK(certify(patch).validity == Validity::folded);
    CHECK(certify(refined(patch, 2)).validity == Validity::folded);
    // All points in one place.
    const Patch<2> point(patch.space(), MatrixX::Zero(8, 2));
    CHECK(certify(point).validity == Validity::folded);
}

TEST_CASE("certify: elements of opposite orientation are folded", "[topology]") {
    const KnotVector two({1, {0, 0, 1, 2, 2}});
    MatrixX points(6, 2);
    points << 0, 0, 2, 0, 1, 0, 0, 1, 2, 1, 1, 1;
    const PatchCertificate<2> certificate =
        certify(Surface({{two, KnotVector::uniform(1, 1)}}, points));
    CHECK(certificate.validity == Validity::folded);
    CHECK(certificate.orientation == 1);
    CHECK(certificate.min_jacobian == Approx(-1.0));
    CHECK(certificate.min_coefficient == Approx(-1.0));
    CHECK(certificate.min_xi[0] >= 1.0);
}

TEST_CASE("certify: degree 8 in all directions", "[topology]") {
    const Patch<3> patch = polynomial_patch<3>({8, 8, 8}, [](const Vector3& u) {
        return Vector3(u[0] + 0.05 * std::pow(u[1], 8), u[1] + 0.05 * std::pow(u[2], 8),
                       u[2] + 0.05 * std::pow(u[0], 8));
    });
    // det J = 1 + 0.4^3 (u v w)^7.
    const PatchCertificate<3> certificate = certify(patch);
    CHECK(certificate.validity == Validity::valid);
    // Control points of degree 8 from interpolation: condition about 1e3 per direction.
    constexpr double interpolated = 1e-7;
    CHECK(certificate.min_coefficient == Approx(1.0).epsilon(interpolated));
    CHECK(certificate.min_jacobian == Approx(1.0).epsilon(interpolated));
}

TEST_CASE("certify: surfaces in space have no det J", "[topology]") {
    const Patch<2> flat = make_box<2>(Vector2(1.0, 1.0));
    MatrixX points = MatrixX::Zero(4, 3);
    points.leftCols(2) = flat.control_points();
    CHECK_THROWS_WITH(certify(Surface(flat.space(), points)),
                      "certify: a patch with 2 parameters in 3 dimensions; det J needs as many "
                      "dimensions as parameters");
    CHECK(to_string(Validity::folded) == "folded");
}
