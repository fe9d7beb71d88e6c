#include "meshing/parts/part_landmarks.h"

#include <algorithm>

namespace couture::meshing {

namespace {

constexpr int n_samples = 16;

// Evenly spaced from the first point on; to the last one, or around.
std::vector<Vector3> sample(std::vector<Vector3> points, bool is_closed) {
    if (is_closed) points.push_back(points.front());
    std::vector<double> gone{0.0};
    for (std::size_t k = 1; k < points.size(); ++k) {
        gone.push_back(gone.back() + (points[k] - points[k - 1]).norm());
    }
    std::vector<Vector3> samples;
    std::size_t k = 1;
    for (int i = 0; i < n_samples; ++i) {
        const double wanted = gone.back() * i / (is_closed ? n_samples : n_samples - 1);
        while (k + 1 < points.size() && gone[k] < wanted) ++k;
        const double t = std::clamp((wanted - gone[k - 1]) / (gone[k] - gone[k - 1]), 0.0, 1.0);
        samples.emplace_back((1.0 - t) * points[k - 1] + t * points[k]);
    }
    return samples;
}

}  // namespace

Landmarks part_landmarks(const PartSurface& part) {
    Landmarks landmarks;
    for (const PartCorner& corner : part.corners) {
        landmarks.corners[corner.name] = part.soup.points[corner.vertex];
    }
    for (const PartCurve& curve : part.feature_curves) {
        std::vector<Vector3> points;
        for (const int v : curve.vertices) points.push_back(part.soup.points[v]);
        landmarks.curves[curve.name] = sample(std::move(points), curve.is_closed);
        if (curve.is_closed) landmarks.closed_curves.insert(curve.name);
    }
    return landmarks;
}

}  // namespace couture::meshing
