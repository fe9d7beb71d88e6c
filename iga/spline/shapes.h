#pragma once

#include "iga/spline/patch.h"

namespace couture::iga {

/// Axis-parallel box [0, size], degree 1.
///
/// @throws InputError  unless all sizes are positive
template <int d>
[[nodiscard]] Patch<d> make_box(const Vector<d>& size);
/// Multilinear patch through 2^d corners (rows; first direction fastest), each of d to 3
/// coordinates.
///
/// @throws InputError  if there are not 2^d corners
template <int d>
[[nodiscard]] Patch<d> make_multilinear(const MatrixX& corners);

/// Exact circular arc about the origin from `start` to `start + sweep` radians, 0 < |sweep| <= 2
/// pi, degree 2: one segment for each quarter turn begun, joined by double knots.
///
/// @throws InputError  if the radius is not positive or the sweep out of range
///
/// Source: [PieglTiller97] Sec. 7.5.
[[nodiscard]] Curve make_arc(double radius, double start, double sweep);
/// Arc of an axis-parallel ellipse with half-axes (a, b) between two eccentric angles, like
/// `make_arc`.
[[nodiscard]] Curve make_ellipse_arc(double a, double b, double start, double sweep);

/// Quarter annulus in the first quadrant: direction 0 radial (degree 1), direction 1
/// circumferential (degree 2), right-handed.
///
/// @throws InputError  unless 0 < inner_radius < outer_radius
[[nodiscard]] Surface make_quarter_annulus(double inner_radius, double outer_radius);
/// Straight lines between points of equal parameters of two curves or two surfaces with the same
/// space: the new direction is the last, with `first` at 0 and `last` at 1.
///
/// @throws InputError  if the spaces or the numbers of coordinates differ
[[nodiscard]] Surface make_ruled(const Curve& first, const Curve& last);
[[nodiscard]] Volume make_ruled(const Surface& first, const Surface& last);
/// The surface (in the plane or in space) moved along `direction`: a volume, new direction last.
///
/// @throws InputError  if `direction` is zero or not finite
[[nodiscard]] Volume make_extrusion(const Surface& surface, const Vector3& direction);
/// The plane surface with coordinates (radius, height) = (x, z) turned about the z axis, from the
/// x axis on, by `sweep` radians, 0 < |sweep| <= 2 pi. The new direction is the last. For a
/// positive sweep the volume is right-handed where the surface is left-handed.
///
/// @throws InputError  if the surface has three coordinates or the sweep is out of range
///
/// Source: [PieglTiller97] Sec. 8.5.
[[nodiscard]] Volume make_revolution(const Surface& surface, double sweep);
/// The octant x, y, z >= 0 of a spherical shell: directions radius (degree 1), polar angle from the
/// z axis and azimuth (degree 2), right-handed. The side where the polar angle is 0 collapses to a
/// straight edge on the z axis.
///
/// @throws InputError  unless 0 < inner_radius < outer_radius
[[nodiscard]] Volume make_sphere_shell_patch(double inner_radius, double outer_radius);
/// Bilinearly blended Coons patch from boundary curves: south (eta = 0) and north (eta = 1) along
/// xi on the same knots, west (xi = 0) and east (xi = 1) along eta on the same knots.
///
/// @throws InputError  if knots of opposite curves differ, or curves do not meet in a corner (with
///                     the same weight; distances are measured against the size of the curves)
///
/// Source: [PieglTiller97] Eq. (10.43).
[[nodiscard]] Surface make_coons(const Curve& south, const Curve& north, const Curve& west,
                                 const Curve& east);

}  // namespace couture::iga
