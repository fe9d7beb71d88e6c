#include "meshing/parameterization/sample_quality.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "iga/core/error.h"
#include "meshing/field/aligned_field.h"
#include "meshing/field/face_frames.h"
#include "meshing/surface/surface_distance.h"
#include "meshing/surface/triangle_tree.h"

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

// Calls a function with the number of the quad and the corners of each cell of a grid,
// counter-clockwise.
template <typename Function>
void for_each_cell(const LayoutSamples& samples, const Function& function) {
    for (int q = 0; q < samples.layout.n_quads(); ++q) {
        const int n_s = samples.n_cells[samples.layout.sides(q)[0].arc];
        const int n_t = samples.n_cells[samples.layout.sides(q)[1].arc];
        const auto point = [&](int i, int j) -> Vector3 {
            return samples.quads[q].col(j * (n_s + 1) + i);
        };
        for (int j = 0; j < n_t; ++j) {
            for (int i = 0; i < n_s; ++i) {
                function(q, std::array<Vector3, 4>{point(i, j), point(i + 1, j),
                                                   point(i + 1, j + 1), point(i, j + 1)});
            }
        }
    }
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

std::optional<TurnedCorner> worst_turned_corner(const LayoutSamples& samples,
                                                const SurfaceMesh& mesh) {
    const std::vector<SpaceTriangle> faces = meshing::triangles_of(mesh);
    const TriangleTree tree(faces);
    std::optional<TurnedCorner> worst;
    double least = 0.0;
    for_each_cell(samples, [&](int quad, const std::array<Vector3, 4>& x) {
        const auto& [a, b, c] = faces[tree.nearest(0.25 * (x[0] + x[1] + x[2] + x[3])).triangle];
        const Vector3 normal = (b - a).cross(c - a).normalized();
        for (int k = 0; k < 4; ++k) {
            const Vector3 ahead = (x[(k + 1) % 4] - x[k]).normalized();
            const Vector3 behind = (x[(k + 3) % 4] - x[k]).normalized();
            const double turn = ahead.cross(behind).dot(normal);
            if (turn >= least) continue;
            least = turn;
            worst = {quad, x[k]};
        }
    });
    return worst;
}

double mean_angle_to_field(const LayoutSamples& samples, const SurfaceMesh& mesh,
                           const DirectionField& field) {
    const TriangleTree tree(meshing::triangles_of(mesh));
    const FaceFrames frames(mesh);
    double sum = 0.0;
    double area = 0.0;
    for_each_cell(samples, [&](int, const std::array<Vector3, 4>& x) {
        const FaceHandle face(tree.nearest(0.25 * (x[0] + x[1] + x[2] + x[3])).triangle);
        const Vector3 along = 0.5 * (x[1] + x[2] - x[0] - x[3]);
        const Vector3 across = 0.5 * (x[2] + x[3] - x[0] - x[1]);
        const double of_cell = along.cross(across).norm();
        area += of_cell;
        for (const Vector3& direction : {along, across}) {
            const double angle = frames.angle_of(face, direction);
            sum += 0.5 * of_cell * std::abs(nearest_offset(field, face, angle));
        }
    });
    return area > 0.0 ? sum / area : 0.0;
}

}  // namespace couture::meshing
