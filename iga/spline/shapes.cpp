#include "iga/spline/shapes.h"

#include <cmath>
#include <numbers>

#include "iga/core/error.h"

namespace couture::iga {

namespace {

/// Curves that miss each other by less than this part of their size are joined.
constexpr double corner_tolerance = 1e-10;

/// (cos, sin), exactly 0 at multiples of a quarter turn known to double precision.
Vector2 unit_vector(double angle) {
    const double rounding = 4e-16 * std::max(1.0, std::abs(angle));
    Vector2 result(std::cos(angle), std::sin(angle));
    for (int i = 0; i < 2; ++i) {
        if (std::abs(result[i]) < rounding) {
            result[i] = 0.0;
            result[1 - i] = result[1 - i] > 0.0 ? 1.0 : -1.0;
        }
    }
    return result;
}

void check_radii(const char* who, double inner_radius, double outer_radius) {
    if (!(inner_radius > 0.0 && inner_radius < outer_radius) || !std::isfinite(outer_radius)) {
        throw InputError("{}: inner radius {}, outer radius {}; needs 0 < inner < outer", who,
                         inner_radius, outer_radius);
    }
}

/// Linear in a new last direction between two patches of one space.
template <int d>
Patch<d + 1> rule(const Patch<d>& first, const Patch<d>& last) {
    if (first.space() != last.space()) {
        throw InputError(
            "make_ruled: the two sides have {} and {} control points or other knots; they need the "
            "same space, see common_refinement",
            first.space().n_basis(), last.space().n_basis());
    }
    if (first.dimension() != last.dimension()) {
        throw InputError("make_ruled: points of {} and {} coordinates; the two sides need as many",
                         first.dimension(), last.dimension());
    }
    MatrixX rows(2 * first.space().n_basis(), first.dimension() + 1);
    rows << first.homogeneous(), last.homogeneous();
    const KnotVector line = KnotVector::uniform(1, 1);
    const bool is_rational = first.is_rational() || last.is_rational();
    if constexpr (d == 1) {
        return Surface::from_homogeneous({{first.knots(0), line}}, rows, is_rational);
    } else {
        return Volume::from_homogeneous({{first.knots(0), first.knots(1), line}}, rows,
                                        is_rational);
    }
}

/// Greville points of the knots as parts of their interval: coefficients of the parameter itself.
VectorX linear_coefficients(const KnotVector& knots) {
    const std::vector<double> points = knots.greville();
    VectorX result(knots.n_basis());
    for (int i = 0; i < knots.n_basis(); ++i) {
        result[i] = (points[i] - knots.front()) / (knots.back() - knots.front());
    }
    result[0] = 0.0;
    result[knots.n_basis() - 1] = 1.0;
    return result;
}

}  // namespace

template <int d>
Patch<d> make_box(const Vector<d>& size) {
    for (int k = 0; k < d; ++k) {
        if (!(size[k] > 0.0)) {
            throw InputError("make_box: size {} in direction {}; must be positive", size[k], k);
        }
    }
    MatrixX corners(1 << d, d);
    for (int i = 0; i < corners.rows(); ++i) {
        for (int k = 0; k < d; ++k) {
            corners(i, k) = (i >> k & 1) != 0 ? size[k] : 0.0;
        }
    }
    return make_multilinear<d>(corners);
}

template <int d>
Patch<d> make_multilinear(const MatrixX& corners) {
    if (corners.rows() != 1 << d) {
        throw InputError("make_multilinear: {} corners; {} parameters take {}", corners.rows(), d,
                         1 << d);
    }
    const KnotVector line = KnotVector::uniform(1, 1);
    if constexpr (d == 1) {
        return {{{line}}, corners};
    } else if constexpr (d == 2) {
        return {{{line, line}}, corners};
    } else {
        return {{{line, line, line}}, corners};
    }
}

Curve make_arc(double radius, double start, double sweep) {
    return make_ellipse_arc(radius, radius, start, sweep);
}

Curve make_ellipse_arc(double a, double b, double start, double sweep) {
    if (!(a > 0.0 && b > 0.0)) {
        throw InputError("make_ellipse_arc: half-axes {} and {}; must be positive", a, b);
    }
    // Angles that users compute may miss quarter turns by rounding.
    constexpr double slack = 1e-12;
    const double n_quarters = std::abs(sweep) / (0.5 * std::numbers::pi);
    if (!(n_quarters > 0.0 && n_quarters <= 4.0 + slack)) {
        throw InputError("make_ellipse_arc: sweep {}; must be from -2 pi to 2 pi and not 0", sweep);
    }
    const int n_segments = std::max(1, static_cast<int>(std::ceil(n_quarters - slack)));
    const double half = 0.5 * sweep / n_segments;
    MatrixX points(2 * n_segments + 1, 2);
    VectorX weights(2 * n_segments + 1);
    for (int i = 0; i <= 2 * n_segments; ++i) {
        weights[i] = i % 2 == 0 ? 1.0 : std::cos(half);
        const Vector2 direction = unit_vector(start + i * half) / weights[i];
        points.row(i) << a * direction.x(), b * direction.y();
    }
    std::vector<double> knots{0.0, 0.0, 0.0};
    for (int i = 1; i < n_segments; ++i) {
        knots.insert(knots.end(), 2, static_cast<double>(i) / n_segments);
    }
    knots.insert(knots.end(), 3, 1.0);
    return {{{KnotVector(2, std::move(knots))}}, points, weights};
}

Surface make_quarter_annulus(double inner_radius, double outer_radius) {
    check_radii("make_quarter_annulus", inner_radius, outer_radius);
    const Curve arc = make_arc(1.0, 0.0, 0.5 * std::numbers::pi);
    MatrixX points(6, 2);
    VectorX weights(6);
    for (int j = 0; j < 3; ++j) {
        points.row(2 * j) = inner_radius * arc.control_points().row(j);
        points.row(2 * j + 1) = outer_radius * arc.control_points().row(j);
        weights.segment(2 * j, 2).setConstant(arc.weights()[j]);
    }
    return {{{KnotVector::uniform(1, 1), arc.knots(0)}}, points, weights};
}

Surface make_ruled(const Curve& first, const Curve& last) { return rule<1>(first, last); }

Volume make_ruled(const Surface& first, const Surface& last) { return rule<2>(first, last); }

Volume make_extrusion(const Surface& surface, const Vector3& direction) {
    if (!direction.allFinite() || direction.isZero(0.0)) {
        throw InputError("make_extrusion: direction ({}, {}, {}); must be finite and not zero",
                         direction.x(), direction.y(), direction.z());
    }
    MatrixX points = MatrixX::Zero(surface.space().n_basis(), 3);
    points.leftCols(surface.dimension()) = surface.control_points();
    const MatrixX moved = points.rowwise() + direction.transpose();
    return rule<2>({surface.space(), points, surface.weights()},
                   {surface.space(), moved, surface.weights()});
}

Volume make_revolution(const Surface& surface, double sweep) {
    if (surface.dimension() != 2) {
        throw InputError(
            "make_revolution: points of {} coordinates; the surface needs 2, radius and height",
            surface.dimension());
    }
    const Curve arc = make_arc(1.0, 0.0, sweep);
    const int n_surface = surface.space().n_basis();
    const int n_arc = arc.space().n_basis();
    MatrixX points(n_surface * n_arc, 3);
    VectorX weights(n_surface * n_arc);
    for (int j = 0; j < n_arc; ++j) {
        for (int i = 0; i < n_surface; ++i) {
            const double radius = surface.control_points()(i, 0);
            points.row(j * n_surface + i) << radius * arc.control_points()(j, 0),
                radius * arc.control_points()(j, 1), surface.control_points()(i, 1);
            weights[j * n_surface + i] =
                arc.weights()[j] * (surface.is_rational() ? surface.weights()[i] : 1.0);
        }
    }
    return {{{surface.knots(0), surface.knots(1), arc.knots(0)}}, points, weights};
}

Volume make_sphere_shell_patch(double inner_radius, double outer_radius) {
    check_radii("make_sphere_shell_patch", inner_radius, outer_radius);
    const Surface annulus = make_quarter_annulus(inner_radius, outer_radius);
    const MatrixX from_pole = annulus.control_points().rowwise().reverse();
    return make_revolution({annulus.space(), from_pole, annulus.weights()}, 0.5 * std::numbers::pi);
}

Surface make_coons(const Curve& south, const Curve& north, const Curve& west, const Curve& east) {
    if (south.space() != north.space() || west.space() != east.space()) {
        throw InputError(
            "make_coons: {} curves have different knots; opposite curves need the same, see "
            "common_refinement",
            south.space() != north.space() ? "south and north" : "west and east");
    }
    if (north.dimension() != south.dimension() || west.dimension() != south.dimension() ||
        east.dimension() != south.dimension()) {
        throw InputError(
            "make_coons: south, north, west, east have {}, {}, {}, {} coordinates; they need as "
            "many",
            south.dimension(), north.dimension(), west.dimension(), east.dimension());
    }
    const MatrixX S = south.homogeneous();
    const MatrixX N = north.homogeneous();
    const MatrixX W = west.homogeneous();
    const MatrixX E = east.homogeneous();
    const Eigen::Index m = S.rows();
    const Eigen::Index n = W.rows();
    const double size = std::max(south.control_points().cwiseAbs().maxCoeff(),
                                 north.control_points().cwiseAbs().maxCoeff());
    const Eigen::Index dimension = south.dimension();
    const auto check_corner = [&](const char* name, const auto& a, const auto& b) {
        const double weight_a = a[dimension];
        const double weight_b = b[dimension];
        const double distance =
            (a.head(dimension) / weight_a - b.head(dimension) / weight_b).norm();
        if (!(distance <= corner_tolerance * size)) {
            throw InputError("make_coons: the curves of the {} corner end {} apart; they must meet",
                             name, distance);
        }
        if (!(std::abs(weight_a - weight_b) <= corner_tolerance * weight_a)) {
            throw InputError(
                "make_coons: the curves of the {} corner end with weights {} and {}; they need the "
                "same",
                name, weight_a, weight_b);
        }
    };
    check_corner("south-west", S.row(0), W.row(0));
    check_corner("south-east", S.row(m - 1), E.row(0));
    check_corner("north-west", N.row(0), W.row(n - 1));
    check_corner("north-east", N.row(m - 1), E.row(n - 1));

    const VectorX u = linear_coefficients(south.knots(0));
    const VectorX v = linear_coefficients(west.knots(0));
    MatrixX rows(m * n, S.cols());
    for (Eigen::Index j = 0; j < n; ++j) {
        for (Eigen::Index i = 0; i < m; ++i) {
            const Eigen::RowVectorXd along_xi = (1.0 - v[j]) * S.row(i) + v[j] * N.row(i);
            const Eigen::RowVectorXd along_eta = (1.0 - u[i]) * W.row(j) + u[i] * E.row(j);
            const Eigen::RowVectorXd corners =
                (1.0 - v[j]) * ((1.0 - u[i]) * S.row(0) + u[i] * S.row(m - 1)) +
                v[j] * ((1.0 - u[i]) * N.row(0) + u[i] * N.row(m - 1));
            rows.row(j * m + i) = along_xi + along_eta - corners;
        }
    }
    const bool is_rational =
        south.is_rational() || north.is_rational() || west.is_rational() || east.is_rational();
    return Surface::from_homogeneous({{south.knots(0), west.knots(0)}}, rows, is_rational);
}

template Patch<1> make_box<1>(const Vector<1>&);
template Patch<2> make_box<2>(const Vector<2>&);
template Patch<3> make_box<3>(const Vector<3>&);
template Patch<1> make_multilinear<1>(const MatrixX&);
template Patch<2> make_multilinear<2>(const MatrixX&);
template Patch<3> make_multilinear<3>(const MatrixX&);

}  // namespace couture::iga
