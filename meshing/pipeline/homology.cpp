#include "meshing/pipeline/homology.h"

#include <algorithm>
#include <limits>

#include "iga/core/error.h"

namespace couture::meshing {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

struct Polyline {
    std::vector<Vector3> points;

    [[nodiscard]] double distance(const Vector3& x) const {
        double least = infinity;
        for (std::size_t k = 0; k + 1 < points.size(); ++k) {
            const Vector3 along = points[k + 1] - points[k];
            const double squared = along.squaredNorm();
            const double t = squared > 0.0 ? (x - points[k]).dot(along) / squared : 0.0;
            const Vector3 there = points[k] + std::clamp(t, 0.0, 1.0) * along;
            least = std::min(least, (x - there).squaredNorm());
        }
        return std::sqrt(least);
    }
};

Polyline line_of(const NamedFeatures::Curve& curve) {
    Polyline line{curve.points};
    if (curve.is_closed) line.points.push_back(curve.points.front());
    return line;
}

// Evenly spaced from the first point on; to the last one, or around.
std::vector<Vector3> spread(const NamedFeatures::Curve& curve, int n) {
    const Polyline line = line_of(curve);
    std::vector<double> gone{0.0};
    for (std::size_t k = 1; k < line.points.size(); ++k) {
        gone.push_back(gone.back() + (line.points[k] - line.points[k - 1]).norm());
    }
    std::vector<Vector3> points;
    std::size_t k = 1;
    for (int i = 0; i < n; ++i) {
        const double wanted = gone.back() * i / (curve.is_closed ? n : n - 1);
        while (k + 1 < line.points.size() && gone[k] < wanted) ++k;
        const double t = std::clamp((wanted - gone[k - 1]) / (gone[k] - gone[k - 1]), 0.0, 1.0);
        points.emplace_back((1.0 - t) * line.points[k - 1] + t * line.points[k]);
    }
    return points;
}

// A point of an edge or a corner.
Vector3 point_on(const iga::MultiPatch<3>& volume, const iga::PatchEntity<3>& entity,
                 double part_of_way) {
    const iga::Patch<3>& patch = volume.patches[entity.patch];
    Vector3 xi;
    for (int i = 0; i < 3; ++i) {
        const double low = patch.knots(i).front();
        const double high = patch.knots(i).back();
        const double t = entity.position[i] == iga::End::free   ? part_of_way
                         : entity.position[i] == iga::End::high ? 1.0
                                                                : 0.0;
        xi[i] = (1.0 - t) * low + t * high;
    }
    return patch.point(xi);
}

Polyline sample_edge(const iga::MultiPatch<3>& volume, const iga::PatchEntity<3>& edge,
                     int n_steps) {
    Polyline line;
    for (int k = 0; k <= n_steps; ++k) {
        line.points.push_back(point_on(volume, edge, static_cast<double>(k) / n_steps));
    }
    return line;
}

// So many steps that chords are as good as the edge.
int fine_steps(const iga::MultiPatch<3>& volume, const iga::PatchEntity<3>& edge) {
    constexpr int steps_per_element = 24;
    for (int i = 0; i < 3; ++i) {
        if (edge.position[i] == iga::End::free) {
            return steps_per_element * volume.patches[edge.patch].knots(i).n_elements();
        }
    }
    return 1;
}

// Corners or edges of patches that lie on outer sides.
std::vector<iga::PatchEntity<3>> outer_entities(const iga::MultiPatch<3>& volume, int dimension) {
    std::vector<iga::PatchEntity<3>> found;
    const auto sides = volume.outer_sides();
    for (int p = 0; p < volume.n_patches(); ++p) {
        for (const auto& entity : iga::entities_of_patch<3>(p, dimension)) {
            const bool is_outer = std::ranges::any_of(sides, [&](const auto& side) {
                const int direction = iga::side_direction(side.side());
                return side.patch == p && entity.position[direction] == side.position[direction];
            });
            if (is_outer) found.push_back(entity);
        }
    }
    return found;
}

void check_images(const iga::MultiPatch<3>& volume, const FeatureImages& images) {
    const auto check = [&](const iga::PatchEntity<3>& entity) {
        if (entity.patch >= 0 && entity.patch < volume.n_patches()) return;
        throw InputError("homology: an image lies on patch {}; the volume has {}", entity.patch,
                         volume.n_patches());
    };
    for (const auto& [name, corner] : images.corners) check(corner);
    for (const auto& [name, edges] : images.curves) std::ranges::for_each(edges, check);
}

}  // namespace

NamedFeatures named_features(const PartSurface& part) {
    NamedFeatures features;
    for (const PartCorner& corner : part.corners) {
        features.corners[corner.name] = part.soup.points[corner.vertex];
    }
    for (const PartCurve& curve : part.feature_curves) {
        NamedFeatures::Curve& named = features.curves[curve.name];
        named.is_closed = curve.is_closed;
        for (const int v : curve.vertices) named.points.push_back(part.soup.points[v]);
    }
    Vector3 low = Vector3::Constant(infinity);
    Vector3 high = -low;
    for (const Vector3& x : part.soup.points) {
        low = low.cwiseMin(x);
        high = high.cwiseMax(x);
    }
    features.diagonal = (high - low).norm();
    return features;
}

FeatureImages find_feature_images(const iga::MultiPatch<3>& volume, const NamedFeatures& features) {
    FeatureImages images;
    const auto nodes = outer_entities(volume, 0);
    for (const auto& [name, x] : features.corners) {
        double least = infinity;
        for (const auto& node : nodes) {
            const double distance = (point_on(volume, node, 0.0) - x).norm();
            if (distance >= least) continue;
            least = distance;
            images.corners[name] = node;
        }
    }
    constexpr int coarse_steps = 8;
    std::vector<std::pair<iga::PatchEntity<3>, Polyline>> edges;
    for (const auto& edge : outer_entities(volume, 1)) {
        edges.emplace_back(edge, sample_edge(volume, edge, coarse_steps));
    }
    const double near = homology_tolerance * features.diagonal;
    for (const auto& [name, curve] : features.curves) {
        const Polyline line = line_of(curve);
        for (const auto& [edge, samples] : edges) {
            const bool lies_on = std::ranges::all_of(
                samples.points, [&](const Vector3& x) { return line.distance(x) <= near; });
            if (lies_on) images.curves[name].push_back(edge);
        }
    }
    return images;
}

HomologyReport measure_homology(const iga::MultiPatch<3>& volume, const NamedFeatures& features,
                                const FeatureImages& images, int points_per_curve) {
    check_images(volume, images);
    if (points_per_curve < 2) {
        throw InputError("homology: {} points per curve; there must be 2 or more",
                         points_per_curve);
    }
    HomologyReport report;
    report.n_corners = static_cast<int>(features.corners.size());
    report.n_curves = static_cast<int>(features.curves.size());
    report.points_per_curve = points_per_curve;
    for (const auto& [name, x] : features.corners) {
        const auto image = images.corners.find(name);
        const double distance =
            image == images.corners.end()
                ? infinity
                : (point_on(volume, image->second, 0.0) - x).norm() / features.diagonal;
        if (distance < report.max_corner_distance) continue;
        report.max_corner_distance = distance;
        report.worst_corner = name;
    }
    for (const auto& [name, curve] : features.curves) {
        std::vector<Polyline> arcs;
        if (const auto image = images.curves.find(name); image != images.curves.end()) {
            for (const auto& edge : image->second) {
                arcs.push_back(sample_edge(volume, edge, fine_steps(volume, edge)));
            }
        }
        for (const Vector3& x : spread(curve, points_per_curve)) {
            double distance = infinity;
            for (const Polyline& arc : arcs) {
                distance = std::min(distance, arc.distance(x) / features.diagonal);
            }
            if (distance < report.max_curve_distance) continue;
            report.max_curve_distance = distance;
            report.worst_curve = name;
        }
    }
    return report;
}

}  // namespace couture::meshing
