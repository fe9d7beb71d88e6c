#include "meshing/surface/map_quality.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "meshing/surface/predicates.h"

namespace couture::meshing {

std::vector<int> flipped_triangles(const CutSurface& surface, std::span<const Vector2> parameters) {
    std::vector<int> flipped;
    for (int f = 0; f < surface.n_faces(); ++f) {
        const auto [a, b, c] = surface.triangle(f);
        if (orientation(parameters[a], parameters[b], parameters[c]) <= 0) flipped.push_back(f);
    }
    return flipped;
}

MapDistortion map_distortion(const CutSurface& surface, std::span<const Vector2> parameters) {
    const auto in_space = [](const Vector2& x) { return Vector3(x.x(), x.y(), 0.0); };
    const auto angle = [](const Vector3& a, const Vector3& b) {
        return std::atan2(a.cross(b).norm(), a.dot(b));
    };
    struct Shape {
        double area;
        std::array<double, 3> angles;
    };
    const auto shape_of = [&](const std::array<Vector3, 3>& corners) {
        Shape shape{};
        shape.area = 0.5 * (corners[1] - corners[0]).cross(corners[2] - corners[0]).norm();
        for (int k = 0; k < 3; ++k) {
            shape.angles[k] =
                angle(corners[(k + 1) % 3] - corners[k], corners[(k + 2) % 3] - corners[k]);
        }
        return shape;
    };

    MapDistortion distortion;
    std::vector<Shape> surface_shapes;
    std::vector<Shape> plane_shapes;
    double surface_area = 0.0;
    double plane_area = 0.0;
    for (int f = 0; f < surface.n_faces(); ++f) {
        const auto [a, b, c] = surface.triangle(f);
        const Shape shape = shape_of({surface.point(a), surface.point(b), surface.point(c)});
        if (!(shape.area > 0.0)) {
            ++distortion.n_without_area;
            continue;
        }
        surface_shapes.push_back(shape);
        plane_shapes.push_back(
            shape_of({in_space(parameters[a]), in_space(parameters[b]), in_space(parameters[c])}));
        surface_area += surface_shapes.back().area;
        plane_area += plane_shapes.back().area;
    }
    if (surface_shapes.empty()) return distortion;

    distortion.smallest_area_ratio = std::numeric_limits<double>::infinity();
    distortion.largest_area_ratio = 0.0;
    double sum = 0.0;
    for (std::size_t i = 0; i < surface_shapes.size(); ++i) {
        const double ratio =
            plane_shapes[i].area / plane_area * (surface_area / surface_shapes[i].area);
        distortion.smallest_area_ratio = std::min(distortion.smallest_area_ratio, ratio);
        distortion.largest_area_ratio = std::max(distortion.largest_area_ratio, ratio);
        for (int k = 0; k < 3; ++k) {
            const double change = std::abs(plane_shapes[i].angles[k] - surface_shapes[i].angles[k]);
            distortion.largest_angle_change = std::max(distortion.largest_angle_change, change);
            sum += change;
        }
    }
    distortion.mean_angle_change = sum / (3.0 * static_cast<double>(surface_shapes.size()));
    return distortion;
}

}  // namespace couture::meshing
