#include "meshing/parameterization/sample_quality.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "iga/core/error.h"
#include "meshing/surface/surface_distance.h"

namespace couture::meshing {

namespace {

std::vector<SpaceTriangle> triangles_of(const QuadMesh& mesh) {
    std::vector<SpaceTriangle> triangles;
    for (const auto& [a, b, c, d] : mesh.quads) {
        triangles.push_back({mesh.points[a], mesh.points[b], mesh.points[c]});
        triangles.push_back({mesh.points[a], mesh.points[c], mesh.points[d]});
    }
    return triangles;
}

}  // namespace

QuadQuality quad_quality(const QuadMesh& quads, const SurfaceMesh& mesh) {
    if (quads.quads.empty() || mesh.n_faces() == 0) {
        throw InputError("quad_quality: {} quads and {} faces; there must be some of both",
                         quads.quads.size(), mesh.n_faces());
    }
    QuadQuality quality;
    quality.smallest_angle = std::numeric_limits<double>::infinity();
    quality.smallest_scaled_jacobian = 1.0;
    for (const auto& quad : quads.quads) {
        const auto corner = [&](int k) -> const Vector3& { return quads.points[quad[k & 3]]; };
        const Vector3 normal = (corner(2) - corner(0)).cross(corner(3) - corner(1)).normalized();
        double least = 1.0;
        double shortest = std::numeric_limits<double>::infinity();
        double longest = 0.0;
        for (int k = 0; k < 4; ++k) {
            const Vector3 a = corner(k + 1) - corner(k);
            const Vector3 b = corner(k + 3) - corner(k);
            const double turn = a.cross(b).dot(normal) / (a.norm() * b.norm());
            least = std::min(least, turn);
            const double angle = std::atan2(a.cross(b).norm(), a.dot(b));
            quality.smallest_angle = std::min(quality.smallest_angle, angle);
            quality.largest_angle = std::max(quality.largest_angle, angle);
            shortest = std::min(shortest, a.norm());
            longest = std::max(longest, a.norm());
        }
        quality.smallest_scaled_jacobian = std::min(quality.smallest_scaled_jacobian, least);
        quality.mean_scaled_jacobian += least;
        quality.largest_edge_ratio = std::max(quality.largest_edge_ratio, longest / shortest);
        quality.mean_edge_ratio += longest / shortest;
    }
    const auto n = static_cast<double>(quads.quads.size());
    quality.mean_scaled_jacobian /= n;
    quality.mean_edge_ratio /= n;
    quality.hausdorff_distance =
        hausdorff_distance(triangles_of(quads), meshing::triangles_of(mesh)) /
        bounding_box_diagonal(mesh);
    return quality;
}

}  // namespace couture::meshing
