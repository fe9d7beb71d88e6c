#include "meshing/surface/triangle_tree.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <numeric>

#include "iga/core/error.h"
#include "meshing/surface/ball_contact.h"

namespace couture::meshing {

namespace {

double squared_distance(const Vector3& point, const Vector3& low, const Vector3& high) {
    return (point - point.cwiseMax(low).cwiseMin(high)).squaredNorm();
}

// Fraction of the way from a to b that is nearest.
double nearest_fraction(const Vector3& point, const Vector3& a, const Vector3& b) {
    const double length = (b - a).squaredNorm();
    return length > 0.0 ? std::clamp((point - a).dot(b - a) / length, 0.0, 1.0) : 0.0;
}

// How far along a line a box begins that is larger by the radius on all sides; infinity if the line
// misses it.
double box_distance(const Vector3& start, const Vector3& direction, double radius,
                    const Vector3& low, const Vector3& high) {
    double begin = 0.0;
    double end = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
        const double to_low = low[axis] - radius - start[axis];
        const double to_high = high[axis] + radius - start[axis];
        if (direction[axis] == 0.0) {
            if (to_low > 0.0 || to_high < 0.0) return std::numeric_limits<double>::infinity();
            continue;
        }
        const double a = to_low / direction[axis];
        const double b = to_high / direction[axis];
        begin = std::max(begin, std::min(a, b));
        end = std::min(end, std::max(a, b));
    }
    return begin <= end ? begin : std::numeric_limits<double>::infinity();
}

}  // namespace

Vector3 nearest_weights(const Vector3& point, const std::array<Vector3, 3>& triangle) {
    // Of a triangle that is a segment but for rounding the edges are enough.
    constexpr double smallest_sine = 1e-12;
    const Vector3 along = triangle[1] - triangle[0];
    const Vector3 across = triangle[2] - triangle[0];
    const Vector3 normal = along.cross(across);
    const double area = normal.squaredNorm();
    const bool has_area =
        area > smallest_sine * smallest_sine * along.squaredNorm() * across.squaredNorm();
    Vector3 inside = Vector3::Constant(-1.0);
    for (int k = 0; k < 3 && has_area; ++k) {
        const Vector3& a = triangle[(k + 1) % 3];
        const Vector3& b = triangle[(k + 2) % 3];
        inside[k] = (b - a).cross(point - a).dot(normal) / area;
    }
    if (inside.minCoeff() >= 0.0) return inside / inside.sum();
    Vector3 best = Vector3::Zero();
    double nearest = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 3; ++k) {
        const int next = (k + 1) % 3;
        const double t = nearest_fraction(point, triangle[k], triangle[next]);
        const double distance =
            ((1.0 - t) * triangle[k] + t * triangle[next] - point).squaredNorm();
        if (distance >= nearest) continue;
        nearest = distance;
        best = Vector3::Zero();
        best[k] = 1.0 - t;
        best[next] = t;
    }
    return best;
}

TriangleTree::TriangleTree(std::vector<std::array<Vector3, 3>> triangles)
    : triangles_(std::move(triangles)), order_(triangles_.size()) {
    if (triangles_.empty()) {
        throw InputError("TriangleTree: there are no triangles; give one or more");
    }
    std::iota(order_.begin(), order_.end(), 0);
    build(0, static_cast<int>(order_.size()));
}

int TriangleTree::build(int begin, int end) {
    Box box{triangles_[order_[begin]][0], triangles_[order_[begin]][0], begin, end};
    for (int i = begin; i < end; ++i) {
        for (const Vector3& corner : triangles_[order_[i]]) {
            box.low = box.low.cwiseMin(corner);
            box.high = box.high.cwiseMax(corner);
        }
    }
    const int number = static_cast<int>(boxes_.size());
    boxes_.push_back(box);
    constexpr int leaf_size = 4;
    if (end - begin <= leaf_size) return number;
    int axis = 0;
    (box.high - box.low).maxCoeff(&axis);
    const auto centre = [&](int t) {
        return triangles_[t][0][axis] + triangles_[t][1][axis] + triangles_[t][2][axis];
    };
    const int middle = (begin + end) / 2;
    std::nth_element(
        order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
        [&](int a, int b) { return std::pair(centre(a), a) < std::pair(centre(b), b); });
    const int left = build(begin, middle);
    const int right = build(middle, end);
    boxes_[number].left = left;
    boxes_[number].right = right;
    return number;
}

void TriangleTree::search(int number, const Vector3& point, NearestPlace& best) const {
    const Box& box = boxes_[number];
    if (squared_distance(point, box.low, box.high) > best.squared_distance) return;
    if (box.left < 0) {
        for (int i = box.begin; i < box.end; ++i) {
            const auto& triangle = triangles_[order_[i]];
            const Vector3 weights = nearest_weights(point, triangle);
            const Vector3 place =
                weights[0] * triangle[0] + weights[1] * triangle[1] + weights[2] * triangle[2];
            const double distance = (place - point).squaredNorm();
            if (distance < best.squared_distance ||
                (distance == best.squared_distance && order_[i] < best.triangle)) {
                best = {order_[i], weights, place, distance};
            }
        }
        return;
    }
    const auto distance_of = [&](int below) {
        return squared_distance(point, boxes_[below].low, boxes_[below].high);
    };
    const bool is_left_nearer = distance_of(box.left) <= distance_of(box.right);
    search(is_left_nearer ? box.left : box.right, point, best);
    search(is_left_nearer ? box.right : box.left, point, best);
}

NearestPlace TriangleTree::nearest(const Vector3& point) const {
    NearestPlace best;
    best.squared_distance = std::numeric_limits<double>::infinity();
    search(0, point, best);
    return best;
}

std::optional<double> TriangleTree::first_contact(const Vector3& start, const Vector3& direction,
                                                  double radius) const {
    // Boxes end at the triangles: lines in their sides must not miss them by rounding.
    constexpr double rounding = 1e-12;
    const double size = boxes_[0].low.cwiseAbs().cwiseMax(boxes_[0].high.cwiseAbs()).maxCoeff();
    const double margin = radius + rounding * size;
    double first = std::numeric_limits<double>::infinity();
    std::vector<int> open{0};
    while (!open.empty()) {
        const Box& box = boxes_[open.back()];
        open.pop_back();
        if (box_distance(start, direction, margin, box.low, box.high) >= first) continue;
        if (box.left < 0) {
            for (int i = box.begin; i < box.end; ++i) {
                const auto distance = ball_contact(start, direction, radius, triangles_[order_[i]]);
                if (distance) first = std::min(first, *distance);
            }
            continue;
        }
        const auto distance_of = [&](int below) {
            return box_distance(start, direction, margin, boxes_[below].low, boxes_[below].high);
        };
        const bool is_left_nearer = distance_of(box.left) <= distance_of(box.right);
        open.push_back(is_left_nearer ? box.right : box.left);
        open.push_back(is_left_nearer ? box.left : box.right);
    }
    if (first == std::numeric_limits<double>::infinity()) return {};
    return first;
}

}  // namespace couture::meshing
