#include "meshing/surface/surface_distance.h"

#include <algorithm>
#include <cmath>

#include "meshing/surface/triangle_tree.h"

namespace couture::meshing {

namespace {

std::array<Vector3, 4> probes_of(const SpaceTriangle& triangle) {
    const Vector3 centre = (triangle[0] + triangle[1] + triangle[2]) / 3.0;
    return {triangle[0], triangle[1], triangle[2], centre};
}

}  // namespace

std::vector<SpaceTriangle> triangles_of(const SurfaceMesh& mesh) {
    std::vector<SpaceTriangle> triangles;
    triangles.reserve(mesh.n_faces());
    for (const FaceHandle face : mesh.faces()) {
        const auto [a, b, c] = face_vertices(mesh, face);
        triangles.push_back({mesh.point(a), mesh.point(b), mesh.point(c)});
    }
    return triangles;
}

std::vector<double> triangle_distances(std::span<const SpaceTriangle> first,
                                       std::span<const SpaceTriangle> second) {
    const TriangleTree of_first({first.begin(), first.end()});
    const TriangleTree of_second({second.begin(), second.end()});
    std::vector<double> squares(first.size(), 0.0);
    for (std::size_t t = 0; t < first.size(); ++t) {
        for (const Vector3& point : probes_of(first[t])) {
            squares[t] = std::max(squares[t], of_second.nearest(point).squared_distance);
        }
    }
    for (const SpaceTriangle& triangle : second) {
        for (const Vector3& point : probes_of(triangle)) {
            const NearestPlace place = of_first.nearest(point);
            double& square = squares[place.triangle];
            square = std::max(square, place.squared_distance);
        }
    }
    for (double& square : squares) square = std::sqrt(square);
    return squares;
}

double hausdorff_distance(std::span<const SpaceTriangle> first,
                          std::span<const SpaceTriangle> second) {
    return std::ranges::max(triangle_distances(first, second));
}

}  // namespace couture::meshing
