#include "iga/spline/shapes.h"

#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "iga/core/error.h"
#include "iga/spline/gauss.h"

using namespace couture;
using namespace couture::iga;
using std::numbers::pi;

namespace {

/// Conics are exact: only the rounding of one evaluation remains.
constexpr double exact = 1e-14;
/// Quadrature error of smooth rational functions with `n_quadrature` points per element.
constexpr double quadrature_error = 1e-12;
constexpr int n_quadrature = 16;

/// Signed length, area or volume of a patch of as many coordinates as parameters.
template <int d>
double measure(const Patch<d>& patch) {
    const GaussRule& rule = gauss_rule(n_quadrature);
    const std::array<int, d> n_elements = patch.space().n_elements();
    int n_cells = 1;
    int n_points = 1;
    for (int k = 0; k < d; ++k) {
        n_cells *= n_elements[k];
        n_points *= n_quadrature;
    }
    double sum = 0.0;
    for (int cell = 0; cell < n_cells; ++cell) {
        for (int point = 0; point < n_points; ++point) {
            int rest_cell = cell;
            int rest_point = point;
            double weight = 1.0;
            Vector<d> xi;
            for (int k = 0; k < d; ++k) {
                const int e = rest_cell % n_elements[k];
                const int i = rest_point % n_quadrature;
                rest_cell /= n_elements[k];
                rest_point /= n_quadrature;
                const double first = patch.knots(k).breakpoints()[e];
                const double width = patch.knots(k).breakpoints()[e + 1] - first;
                xi[k] = first + width * rule.points[i];
                weight *= width * rule.weights[i];
            }
            sum += weight * patch.jacobian(xi).determinant();
        }
    }
    return sum;
}

constexpr int n_samples = 41;

double sample(int i) { return static_cast<double>(i) / (n_samples - 1); }

}  // namespace

TEST_CASE("shapes: arcs are exact circles of any sweep", "[spline]") {
    for (const double sweep : {0.1, pi / 2, 2.0, pi, -1.5 * pi, 2 * pi}) {
        const Curve arc = make_arc(2.5, 0.3, sweep);
        CHECK(arc.knots(0).n_elements() == static_cast<int>(std::ceil(std::abs(sweep) / pi * 2)));
        double last_angle = 0.0;
        for (int i = 0; i < n_samples; ++i) {
            const VectorX x = arc.point(Vector<1>(sample(i)));
            CHECK(std::abs(x.norm() - 2.5) < 2.5 * exact);
            double angle = std::remainder(std::atan2(x[1], x[0]) - 0.3, 2 * pi);
            if (i > 0) {
                angle = last_angle + std::remainder(angle - last_angle, 2 * pi);
                CHECK((angle - last_angle) * sweep > 0.0);
            }
            last_angle = angle;
        }
        CHECK(last_angle == Approx(sweep).epsilon(1e-12));
    }
    CHECK(make_arc(1.0, 0.0, pi / 2).point(Vector<1>(1.0))[0] == 0.0);
}

TEST_CASE("shapes: ellipse arcs satisfy the equation of the ellipse", "[spline]") {
    const Curve arc = make_ellipse_arc(3.0, 0.5, -1.0, 4.0);
    for (int i = 0; i < n_samples; ++i) {
        const VectorX x = arc.point(Vector<1>(sample(i)));
        CHECK(std::abs(std::hypot(x[0] / 3.0, x[1] / 0.5) - 1.0) < exact);
    }
}

TEST_CASE("shapes: boxes, annuli, extrusions and revolutions have their volumes", "[spline]") {
    CHECK(measure(make_box<1>(Vector<1>(2.0))) == Approx(2.0).epsilon(exact));
    CHECK(measure(make_box<2>(Vector2(2.0, 3.0))) == Approx(6.0).epsilon(exact));
    CHECK(measure(make_box<3>(Vector3(2.0, 3.0, 0.5))) == Approx(3.0).epsilon(exact));

    const Surface annulus = make_quarter_annulus(1.0, 3.0);
    CHECK(measure(annulus) == Approx(2 * pi).epsilon(quadrature_error));
    CHECK(measure(make_extrusion(annulus, Vector3(1.0, 5.0, 2.0))) ==
          Approx(4 * pi).epsilon(quadrature_error));

    // A rectangle of radii 1..2 and heights 3..7; left-handed, so that the ring is right-handed.
    const MatrixX corners = (MatrixX(4, 2) << 1, 3, 1, 7, 2, 3, 2, 7).finished();
    for (const double sweep : {0.5, pi, 2 * pi}) {
        CHECK(measure(make_revolution(make_multilinear<2>(corners), sweep)) ==
              Approx(0.5 * sweep * (4 - 1) * 4).epsilon(quadrature_error));
    }
}

TEST_CASE("shapes: the spherical shell is exact and collapses on its axis", "[spline]") {
    const Volume shell = make_sphere_shell_patch(1.0, 2.0);
    for (int i = 0; i < 5; ++i) {
        for (int j = 0; j < 5; ++j) {
            for (int k = 0; k < 5; ++k) {
                const Vector3 xi(0.25 * i, 0.25 * j, 0.25 * k);
                const VectorX x = shell.point(xi);
                CHECK(std::abs(x.norm() - (1.0 + xi[0])) < 2 * exact);
                CHECK(x.minCoeff() >= 0.0);
                if (j == 0) {
                    CHECK((x - Vector3(0, 0, 1.0 + xi[0])).norm() < exact);
                } else {
                    CHECK(shell.jacobian(xi).determinant() > 0.0);
                }
            }
        }
    }
    CHECK(measure(shell) == Approx(4.0 / 3.0 * pi * (8 - 1) / 8).epsilon(quadrature_error));
}

TEST_CASE("shapes: ruled surfaces have straight lines between their curves", "[spline]") {
    const Curve inner = make_arc(1.0, 0.0, 2.0);
    const Curve outer = make_ellipse_arc(3.0, 2.0, 0.0, 2.0);
    const Surface surface = make_ruled(inner, outer);
    for (int i = 0; i < n_samples; ++i) {
        const double u = sample(i);
        const VectorX middle = 0.5 * (inner.point(Vector<1>(u)) + outer.point(Vector<1>(u)));
        CHECK((surface.point(Vector2(u, 0.0)) - inner.point(Vector<1>(u))).norm() < exact);
        CHECK((surface.point(Vector2(u, 1.0)) - outer.point(Vector<1>(u))).norm() < 4 * exact);
        CHECK((surface.point(Vector2(u, 0.5)) - middle).norm() < 4 * exact);
    }
}

TEST_CASE("shapes: a Coons patch takes its four curves and fills linear ones bilinearly",
          "[spline]") {
    const Curve south = make_arc(1.0, pi, pi / 2);  // (-1, 0) to (0, -1)
    const KnotVector line = KnotVector::uniform(1, 2);
    const auto polyline = [&](double x0, double y0, double xm, double ym, double x1, double y1) {
        return Curve({{line}}, (MatrixX(3, 2) << x0, y0, xm, ym, x1, y1).finished());
    };
    const KnotVector conic = south.knots(0);
    const Curve north({{conic}}, (MatrixX(3, 2) << -1, 2, 0, 2.5, 1, 2).finished());
    const Curve west = polyline(-1, 0, -1.5, 1, -1, 2);
    const Curve east = polyline(0, -1, 0.7, 0.5, 1, 2);
    const Surface coons = make_coons(south, north, west, east);
    for (int i = 0; i < n_samples; ++i) {
        const Vector<1> u(sample(i));
        CHECK((coons.point(Vector2(u[0], 0)) - south.point(u)).norm() < exact);
        CHECK((coons.point(Vector2(u[0], 1)) - north.point(u)).norm() < 4 * exact);
        CHECK((coons.point(Vector2(0, u[0])) - west.point(u)).norm() < 4 * exact);
        CHECK((coons.point(Vector2(1, u[0])) - east.point(u)).norm() < 4 * exact);
    }

    const auto segment = [](double x0, double y0, double x1, double y1) {
        return make_multilinear<1>((MatrixX(2, 2) << x0, y0, x1, y1).finished());
    };
    const MatrixX corners = (MatrixX(4, 2) << 0, 0, 3, 1, -1, 2, 4, 5).finished();
    const Surface bilinear = make_coons(segment(0, 0, 3, 1), segment(-1, 2, 4, 5),
                                        segment(0, 0, -1, 2), segment(3, 1, 4, 5));
    CHECK((bilinear.control_points() - corners).norm() < exact);
}

TEST_CASE("shapes: broken rules are named with their values", "[spline]") {
    const Surface square = make_box<2>(Vector2(1, 1));
    const Curve edge = make_box<1>(Vector<1>(1.0));
    const auto segment = [](double x0, double y0, double x1, double y1) {
        return make_multilinear<1>((MatrixX(2, 2) << x0, y0, x1, y1).finished());
    };
    CHECK_THROWS_WITH(make_box<2>(Vector2(1, -2)),
                      "make_box: size -2 in direction 1; must be positive");
    CHECK_THROWS_WITH(make_multilinear<2>(MatrixX::Zero(3, 2)),
                      "make_multilinear: 3 corners; 2 parameters take 4");
    CHECK_THROWS_WITH(make_arc(0.0, 0.0, 1.0),
                      "make_ellipse_arc: half-axes 0 and 0; must be positive");
    CHECK_THROWS_WITH(make_arc(1.0, 0.0, 7.0),
                      "make_ellipse_arc: sweep 7; must be from -2 pi to 2 pi and not 0");
    CHECK_THROWS_AS(make_arc(1.0, 0.0, 0.0), InputError);
    CHECK_THROWS_WITH(make_quarter_annulus(2.0, 1.0),
                      "make_quarter_annulus: inner radius 2, outer radius 1; needs 0 < inner < "
                      "outer");
    CHECK_THROWS_WITH(make_sphere_shell_patch(0.0, 1.0),
                      "make_sphere_shell_patch: inner radius 0, outer radius 1; needs 0 < inner < "
                      "outer");
    CHECK_THROWS_WITH(make_extrusion(square, Vector3::Zero()),
                      "make_extrusion: direction (0, 0, 0); must be finite and not zero");
    CHECK_THROWS_WITH(make_revolution(make_multilinear<2>(MatrixX::Identity(4, 3)), 1.0),
                      "make_revolution: points of 3 coordinates; the surface needs 2, radius and "
                      "height");
    CHECK_THROWS_WITH(make_ruled(make_arc(1, 0, 1), make_arc(1, 0, 2)),
                      "make_ruled: the two sides have 3 and 5 control points or other knots; they "
                      "need the same space, see common_refinement");
    CHECK_THROWS_WITH(make_ruled(edge, segment(0, 0, 1, 1)),
                      "make_ruled: points of 1 and 2 coordinates; the two sides need as many");
    CHECK_THROWS_WITH(make_coons(make_arc(1, 0, 1), segment(0, 0, 1, 0), segment(0, 0, 1, 0),
                                 segment(0, 0, 1, 0)),
                      "make_coons: south and north curves have different knots; opposite curves "
                      "need the same, see common_refinement");
    CHECK_THROWS_WITH(make_coons(segment(0, 0, 1, 0), segment(0, 1, 1, 1), segment(0, 0, 0, 1),
                                 segment(1, 0, 1, 3)),
                      "make_coons: the curves of the north-east corner end 2 apart; they must "
                      "meet");
    CHECK_THROWS_WITH(make_coons(edge, edge, edge, segment(0, 0, 1, 0)),
                      "make_coons: south, north, west, east have 1, 1, 1, 2 coordinates; they "
                      "need as many");
    const Curve weighted({{KnotVector::uniform(1, 1)}}, (MatrixX(2, 2) << 0, 0, 1, 0).finished(),
                         Vector2(1, 2));
    CHECK_THROWS_WITH(
        make_coons(weighted, segment(0, 1, 1, 1), segment(0, 0, 0, 1), segment(1, 0, 1, 1)),
        "make_coons: the curves of the south-east corner end with weights 2 and 1; "
        "they need the same");
}
