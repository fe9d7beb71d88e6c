#pragma once

#include <functional>

#include "iga/core/types.h"

namespace couture::meshing {

/// A sheet of surface and its image in a plane, on which it is triangulated. Lengths and angles are
/// kept, or angles alone where there is a `scale`. Seen from outside, the plane's first direction
/// turns to its second counter-clockwise.
struct SheetMap {
    /// Of a point of the surface.
    std::function<Vector2(const Vector3&)> to_plane;
    /// A point exactly on the surface, near enough to the inverse of `to_plane`.
    std::function<Vector3(const Vector2&)> to_space;
    /// Length on the surface per length in the plane; nothing: 1.
    std::function<double(const Vector2&)> scale;
    /// Smallest radius of curvature of the surface; nothing: a plane.
    std::function<double(const Vector2&)> radius;
};

/// The side of a surface that is seen from outside: away from its axis or towards it.
enum class Facing { outwards, inwards };

/// Plane through `origin` with unit directions u and v; the outside is where u x v points.
[[nodiscard]] SheetMap plane_map(const Vector3& origin, const Vector3& u, const Vector3& v);

/// Plane through `origin` across a coordinate axis (0, 1, 2); `sign` +1 or -1: where the outside
/// is.
[[nodiscard]] SheetMap coordinate_plane_map(int axis, int sign, const Vector3& origin);

/// Cylinder about the line along z through `centre`, unrolled.
///
/// @param middle_angle  radians; the sheet lies within less than pi on both sides of it
[[nodiscard]] SheetMap cylinder_map(const Vector3& centre, double radius, double middle_angle,
                                    Facing facing);

/// Torus about the line along z through `centre`, seen from outside.
///
/// The plane's coordinates are the angle theta about z and psi(phi) = 2 r / sqrt(R^2 - r^2)
/// atan(sqrt((R - r) / (R + r)) tan(phi / 2)), phi the angle in the tube from the outer equator: a
/// conformal map whose scale is the distance from the axis.
///
/// @param radius  R, of the tube's centre line; larger than `tube_radius` r
/// @param middle  theta and phi; the sheet lies within less than pi of both
[[nodiscard]] SheetMap torus_map(const Vector3& centre, double radius, double tube_radius,
                                 const Vector2& middle);

/// Point of that torus.
[[nodiscard]] Vector3 torus_point(const Vector3& centre, double radius, double tube_radius,
                                  double theta, double phi);

}  // namespace couture::meshing
