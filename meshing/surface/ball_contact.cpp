#include "meshing/surface/ball_contact.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "meshing/surface/triangle_tree.h"

namespace couture::meshing {

namespace {

using Distance = std::optional<double>;

Distance nearer(const Distance& a, const Distance& b) {
    if (!a || !b) return a ? a : b;
    return std::min(*a, *b);
}

/// The place where a t^2 + 2 b t + c falls to 0, if it begins above.
Distance first_root(double a, double b, double c) {
    const double discriminant = b * b - a * c;
    if (!(a > 0.0) || b >= 0.0 || discriminant < 0.0) return {};
    return std::max(0.0, c / (-b + std::sqrt(discriminant)));
}

/// With the triangle's inside, at the distance of the radius from its plane.
Distance face_contact(const Vector3& start, const Vector3& direction, double radius,
                      const std::array<Vector3, 3>& triangle) {
    // So that lines through a common edge meet one of its triangles.
    constexpr double rounding = 1e-12;
    const Vector3 along = triangle[1] - triangle[0];
    const Vector3 across = triangle[2] - triangle[0];
    const Vector3 product = along.cross(across);
    const double area = product.norm();
    if (!(area > rounding * along.norm() * across.norm())) return {};
    Vector3 normal = product / area;
    double height = (start - triangle[0]).dot(normal);
    if (height < 0.0) {
        normal = -normal;
        height = -height;
    }
    const double approach = -direction.dot(normal);
    if (!(approach > 0.0)) return {};
    const double distance = (height - radius) / approach;
    if (distance < 0.0) return {};
    const Vector3 place = start + distance * direction - radius * normal;
    for (int k = 0; k < 3; ++k) {
        const Vector3& a = triangle[k];
        const Vector3& b = triangle[(k + 1) % 3];
        if ((b - a).cross(place - a).dot(product) < -rounding * area * area) return {};
    }
    return distance;
}

Distance vertex_contact(const Vector3& start, const Vector3& direction, double radius,
                        const Vector3& vertex) {
    const Vector3 offset = start - vertex;
    return first_root(1.0, direction.dot(offset), offset.squaredNorm() - radius * radius);
}

/// With the edge between its ends, which are vertices.
Distance edge_contact(const Vector3& start, const Vector3& direction, double radius,
                      const Vector3& a, const Vector3& b) {
    const double length = (b - a).norm();
    if (!(length > 0.0)) return {};
    const Vector3 axis = (b - a) / length;
    const Vector3 offset = (start - a) - axis.dot(start - a) * axis;
    const Vector3 motion = direction - axis.dot(direction) * axis;
    const Distance distance = first_root(motion.squaredNorm(), motion.dot(offset),
                                         offset.squaredNorm() - radius * radius);
    if (!distance) return {};
    const double place = axis.dot(start + *distance * direction - a);
    return place >= 0.0 && place <= length ? distance : Distance();
}

}  // namespace

std::optional<double> ball_contact(const Vector3& start, const Vector3& direction, double radius,
                                   const std::array<Vector3, 3>& triangle) {
    Distance first = face_contact(start, direction, radius, triangle);
    if (!(radius > 0.0)) return first;
    const Vector3 weights = nearest_weights(start, triangle);
    const Vector3 nearest =
        weights[0] * triangle[0] + weights[1] * triangle[1] + weights[2] * triangle[2];
    if ((nearest - start).norm() <= radius) return 0.0;
    for (int k = 0; k < 3; ++k) {
        const Vector3& a = triangle[k];
        first = nearer(first, vertex_contact(start, direction, radius, a));
        first = nearer(first, edge_contact(start, direction, radius, a, triangle[(k + 1) % 3]));
    }
    return first;
}

}  // namespace couture::meshing
