#pragma once

#include "iga/spline/patch.h"

namespace couture::iga {

/// Axis-parallel box [0, size], degree 1.
template <int d>
[[nodiscard]] Patch<d> make_box(const Vector<d>& size);
/// Multilinear patch through 2^d corners (rows; first direction fastest).
template <int d>
[[nodiscard]] Patch<d> make_multilinear(const MatrixX& corners);

/// Exact circular arc about the origin from `start` to `start + sweep` radians (|sweep| < pi for
/// one segment; longer arcs get more segments joined with double knots), degree 2.
/// Source: [PieglTiller97] Sec. 7.5.
[[nodiscard]] Curve make_arc(double radius, double start, double sweep);
/// Arc of an axis-parallel ellipse with half-axes (a, b) between two eccentric angles.
[[nodiscard]] Curve make_ellipse_arc(double a, double b, double start, double sweep);

/// Quarter annulus: direction 0 radial (degree 1), direction 1 circumferential (degree 2).
[[nodiscard]] Surface make_quarter_annulus(double inner_radius, double outer_radius);
/// Linear interpolation between two curves or two surfaces with the same space: the new
/// direction is the last.
[[nodiscard]] Surface make_ruled(const Curve& first, const Curve& last);
[[nodiscard]] Volume make_ruled(const Surface& first, const Surface& last);
/// The surface (in the plane or in space) moved along `direction`: a volume, new direction last.
[[nodiscard]] Volume make_extrusion(const Surface& surface, const Vector3& direction);
/// The surface in the plane (radius, height) = (x, z) turned about the z axis by `sweep` radians.
[[nodiscard]] Volume make_revolution(const Surface& surface, double sweep);
/// Bilinearly (trilinearly) blended Coons patch from boundary curves on common knots.
/// `curves`: south (eta = 0), north (eta = 1), west (xi = 0), east (xi = 1).
[[nodiscard]] Surface make_coons(const Curve& south, const Curve& north, const Curve& west,
                                 const Curve& east);

}  // namespace couture::iga
