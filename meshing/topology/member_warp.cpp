#include "meshing/topology/member_warp.h"

#include <limits>

namespace couture::meshing {

std::pair<Vector3, Vector3> surface_box(const SurfaceMesh& mesh) {
    Vector3 low = Vector3::Constant(std::numeric_limits<double>::infinity());
    Vector3 high = -low;
    for (const auto vertex : mesh.vertices()) {
        if (mesh.is_isolated(vertex)) continue;
        low = low.cwiseMin(mesh.point(vertex));
        high = high.cwiseMax(mesh.point(vertex));
    }
    return {low, high};
}

MemberWarp::MemberWarp(const PantsRecord& from, const SurfaceMesh& mesh, const Landmarks& landmarks)
    : low_(from.box_min) {
    const auto [low, high] = surface_box(mesh);
    to_low_ = low;
    for (int i = 0; i < 3; ++i) {
        const double size = from.box_max[i] - from.box_min[i];
        scale_[i] = size > 0.0 ? (high[i] - to_low_[i]) / size : 1.0;
    }
    for (const auto& [name, x] : from.landmarks.corners) {
        if (const auto other = landmarks.corners.find(name); other != landmarks.corners.end()) {
            add(x, other->second);
        }
    }
    for (const auto& [name, points] : from.landmarks.curves) {
        const auto other = landmarks.curves.find(name);
        if (other == landmarks.curves.end() || other->second.size() != points.size()) continue;
        add_curve(points, other->second, from.landmarks.closed_curves.contains(name));
    }
}

Vector3 MemberWarp::operator()(const Vector3& x) const {
    Vector3 sum = Vector3::Zero();
    double weights = 0.0;
    for (const auto& [place, miss] : misses_) {
        const double squared = (x - place).squaredNorm();
        if (squared == 0.0) return by_box(x) + miss;
        const double weight = 1.0 / (squared * squared);
        sum += weight * miss;
        weights += weight;
    }
    return weights > 0.0 ? Vector3(by_box(x) + sum / weights) : by_box(x);
}

Vector3 MemberWarp::by_box(const Vector3& x) const {
    return to_low_ + scale_.cwiseProduct(x - low_);
}

void MemberWarp::add(const Vector3& from, const Vector3& to) {
    misses_.emplace_back(from, to - by_box(from));
}

// A closed curve may start anywhere and run either way, an open one start at either end: as
// near as can be.
void MemberWarp::add_curve(const std::vector<Vector3>& from, const std::vector<Vector3>& to,
                           bool is_closed) {
    const int n = static_cast<int>(from.size());
    double least = std::numeric_limits<double>::infinity();
    std::vector<int> best;
    for (const int direction : {1, -1}) {
        for (int shift = 0; shift < (is_closed ? n : 1); ++shift) {
            const int start = direction > 0 ? shift : n - 1 - shift;
            std::vector<int> partner(n);
            double sum = 0.0;
            for (int k = 0; k < n; ++k) {
                partner[k] = ((start + direction * k) % n + n) % n;
                sum += (to[partner[k]] - by_box(from[k])).squaredNorm();
            }
            if (sum < least * (1.0 - 1e-9)) {
                least = sum;
                best = partner;
            }
        }
    }
    for (int k = 0; k < n; ++k) add(from[k], to[best[k]]);
}

}  // namespace couture::meshing
