#include "meshing/surface/planar_map.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "iga/core/error.h"
#include "meshing/surface/predicates.h"

namespace couture::meshing {

namespace {

constexpr int leaf_size = 4;
constexpr double outside_tolerance = 1e-12;

double squared_distance(const Vector2& point, const Vector2& low, const Vector2& high) {
    return (point - point.cwiseMax(low).cwiseMin(high)).squaredNorm();
}

bool contains(const std::array<Vector2, 3>& corners, const Vector2& point) {
    for (int k = 0; k < 3; ++k) {
        if (orientation(corners[k], corners[(k + 1) % 3], point) < 0) return false;
    }
    return true;
}

double determinant(const Vector2& a, const Vector2& b) { return a.x() * b.y() - a.y() * b.x(); }

// Nearest place on the rim of a triangle, and its squared distance.
std::pair<Vector3, double> nearest_on_rim(const std::array<Vector2, 3>& corners,
                                          const Vector2& point) {
    Vector3 weights = Vector3::Zero();
    double nearest = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 3; ++k) {
        const Vector2& a = corners[k];
        const Vector2 edge = corners[(k + 1) % 3] - a;
        const double t = std::clamp((point - a).dot(edge) / edge.squaredNorm(), 0.0, 1.0);
        const double distance = (point - a - t * edge).squaredNorm();
        if (!(distance < nearest)) continue;
        nearest = distance;
        weights.setZero();
        weights[k] = 1.0 - t;
        weights[(k + 1) % 3] = t;
    }
    return {weights, nearest};
}

}  // namespace

Vector3 barycentric_weights(const Vector2& point, const std::array<Vector2, 3>& triangle) {
    Vector3 weights;
    for (int k = 0; k < 3; ++k) {
        const Vector2& a = triangle[(k + 1) % 3];
        const Vector2& b = triangle[(k + 2) % 3];
        weights[k] = orientation(a, b, point) == 0 ? 0.0 : std::abs(determinant(b - a, point - a));
    }
    return weights / weights.sum();
}

PlanarMap::PlanarMap(const CutSurface& surface, std::vector<Vector2> parameters)
    : surface_(&surface), parameters_(std::move(parameters)) {
    if (parameters_.size() != static_cast<std::size_t>(surface.n_vertices())) {
        throw InputError("PlanarMap: {} parameters for {} vertices; each vertex needs one",
                         parameters_.size(), surface.n_vertices());
    }
    for (int f = 0; f < surface.n_faces(); ++f) order_.push_back(f);
    if (!order_.empty()) build(0, surface.n_faces());
}

int PlanarMap::build(int begin, int end) {
    const auto corners_low_high = [&](int f) {
        const auto [a, b, c] = surface_->triangle(f);
        const Vector2& p = parameters_[a];
        const Vector2& q = parameters_[b];
        const Vector2& r = parameters_[c];
        return std::pair<Vector2, Vector2>(p.cwiseMin(q).cwiseMin(r), p.cwiseMax(q).cwiseMax(r));
    };
    auto [low, high] = corners_low_high(order_[begin]);
    for (int i = begin + 1; i < end; ++i) {
        const auto [face_low, face_high] = corners_low_high(order_[i]);
        low = low.cwiseMin(face_low);
        high = high.cwiseMax(face_high);
    }
    const int node = static_cast<int>(boxes_.size());
    boxes_.push_back({low, high, begin, end, -1, -1});
    if (end - begin <= leaf_size) {
        std::sort(order_.begin() + begin, order_.begin() + end);
        return node;
    }
    const int axis = high.x() - low.x() >= high.y() - low.y() ? 0 : 1;
    const auto key = [&](int f) {
        const auto [a, b, c] = surface_->triangle(f);
        return parameters_[a][axis] + parameters_[b][axis] + parameters_[c][axis];
    };
    const int middle = begin + (end - begin) / 2;
    std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                     [&](int f, int g) { return std::pair(key(f), f) < std::pair(key(g), g); });
    const int left = build(begin, middle);
    const int right = build(middle, end);
    boxes_[node].left = left;
    boxes_[node].right = right;
    return node;
}

std::optional<MapPoint> PlanarMap::locate(const Vector2& point, double tolerance) const {
    const auto corners_of = [&](int f) {
        const auto [a, b, c] = surface_->triangle(f);
        return std::array<Vector2, 3>{parameters_[a], parameters_[b], parameters_[c]};
    };
    if (boxes_.empty() || !point.allFinite()) return std::nullopt;
    int inside = -1;
    double nearest = tolerance * tolerance;
    std::optional<MapPoint> outside;
    std::vector<int> stack{0};
    while (!stack.empty()) {
        const Box& box = boxes_[stack.back()];
        stack.pop_back();
        const double distance = squared_distance(point, box.low, box.high);
        if (distance > nearest || (inside >= 0 && distance > 0.0)) continue;
        if (box.left >= 0) {
            stack.push_back(box.right);
            stack.push_back(box.left);
            continue;
        }
        for (int i = box.begin; i < box.end; ++i) {
            const int f = order_[i];
            const auto corners = corners_of(f);
            if (contains(corners, point)) {
                if (inside < 0 || f < inside) inside = f;
            } else if (inside < 0 && tolerance > 0.0) {
                const auto [weights, squared] = nearest_on_rim(corners, point);
                if (squared < nearest || (squared == nearest && (!outside || f < outside->face))) {
                    nearest = squared;
                    outside = MapPoint{f, weights};
                }
            }
        }
    }
    if (inside < 0) return outside;
    return MapPoint{inside, barycentric_weights(point, corners_of(inside))};
}

Vector3 PlanarMap::point(const MapPoint& place) const {
    const auto [a, b, c] = surface_->triangle(place.face);
    return place.weights[0] * surface_->point(a) + place.weights[1] * surface_->point(b) +
           place.weights[2] * surface_->point(c);
}

Vector2 PlanarMap::parameters_at(const MapPoint& place) const {
    const auto [a, b, c] = surface_->triangle(place.face);
    return place.weights[0] * parameters_[a] + place.weights[1] * parameters_[b] +
           place.weights[2] * parameters_[c];
}

Vector3 PlanarMap::point_at(const Vector2& parameters) const {
    if (boxes_.empty()) throw GeometryError("PlanarMap: the map has no triangles");
    const double size = (boxes_[0].high - boxes_[0].low).norm();
    const auto place = locate(parameters, outside_tolerance * size);
    if (!place) {
        throw GeometryError(
            "PlanarMap: ({}, {}) lies outside the map, whose bounding box is [{}, {}] x [{}, {}]",
            parameters.x(), parameters.y(), boxes_[0].low.x(), boxes_[0].high.x(),
            boxes_[0].low.y(), boxes_[0].high.y());
    }
    return point(*place);
}

}  // namespace couture::meshing
