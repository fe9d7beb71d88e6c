#include "meshing/parts/sheet_map.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace couture::meshing {

namespace {

/// The angle of (x, y), within pi of `middle`.
double angle_near(double x, double y, double middle) {
    const double c = std::cos(middle);
    const double s = std::sin(middle);
    return middle + std::atan2(c * y - s * x, c * x + s * y);
}

}  // namespace

SheetMap plane_map(const Vector3& origin, const Vector3& u, const Vector3& v) {
    return {[=](const Vector3& x) { return Vector2((x - origin).dot(u), (x - origin).dot(v)); },
            [=](const Vector2& p) -> Vector3 { return origin + p.x() * u + p.y() * v; }, nullptr,
            nullptr};
}

SheetMap coordinate_plane_map(int axis, int sign, const Vector3& origin) {
    const int u = (axis + (sign > 0 ? 1 : 2)) % 3;
    const int v = (axis + (sign > 0 ? 2 : 1)) % 3;
    // No sums: points of the plane keep their coordinate across it to the last bit.
    const double level = origin[axis];
    return {[=](const Vector3& x) { return Vector2(x[u], x[v]); },
            [=](const Vector2& p) {
                Vector3 x;
                x[axis] = level;
                x[u] = p.x();
                x[v] = p.y();
                return x;
            },
            nullptr, nullptr};
}

SheetMap cylinder_map(const Vector3& centre, double radius, double middle_angle, Facing facing) {
    const double sign = facing == Facing::outwards ? 1.0 : -1.0;
    return {[=](const Vector3& x) {
                const double angle =
                    angle_near(x.x() - centre.x(), x.y() - centre.y(), middle_angle);
                return Vector2(sign * radius * angle, x.z());
            },
            [=](const Vector2& p) {
                const double angle = sign * p.x() / radius;
                return Vector3(centre.x() + radius * std::cos(angle),
                               centre.y() + radius * std::sin(angle), p.y());
            },
            nullptr, [=](const Vector2& /*p*/) { return radius; }};
}

Vector3 torus_point(const Vector3& centre, double radius, double tube_radius, double theta,
                    double phi) {
    const double rho = radius + tube_radius * std::cos(phi);
    return centre +
           Vector3(rho * std::cos(theta), rho * std::sin(theta), tube_radius * std::sin(phi));
}

SheetMap torus_map(const Vector3& centre, double radius, double tube_radius,
                   const Vector2& middle) {
    const double root = std::sqrt((radius - tube_radius) / (radius + tube_radius));
    const double factor =
        2.0 * tube_radius / std::sqrt(radius * radius - tube_radius * tube_radius);
    const auto phi_of = [=](double psi) {
        return 2.0 * std::atan2(std::sin(psi / factor), root * std::cos(psi / factor));
    };
    return {[=](const Vector3& x) {
                const Vector3 local = x - centre;
                const double rho = std::hypot(local.x(), local.y());
                const double theta = angle_near(local.x(), local.y(), middle[0]);
                const double phi = angle_near(rho - radius, local.z(), middle[1]);
                return Vector2(
                    theta, factor * std::atan2(root * std::sin(phi / 2.0), std::cos(phi / 2.0)));
            },
            [=](const Vector2& p) {
                return torus_point(centre, radius, tube_radius, p.x(), phi_of(p.y()));
            },
            [=](const Vector2& p) { return radius + tube_radius * std::cos(phi_of(p.y())); },
            [=](const Vector2& p) {
                const double rho = radius + tube_radius * std::cos(phi_of(p.y()));
                return std::min(tube_radius, rho);
            }};
}

}  // namespace couture::meshing
