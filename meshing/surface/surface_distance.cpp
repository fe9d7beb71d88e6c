#include "meshing/surface/surface_distance.h"

#include <algorithm>
#include <cmath>

#include "meshing/surface/triangle_tree.h"

namespace couture::meshing {

namespace {

double one_sided_distance(std::span<const SpaceTriangle> from, const TriangleTree& to) {
    double largest = 0.0;
    for (const SpaceTriangle& triangle : from) {
        const Vector3 centre = (triangle[0] + triangle[1] + triangle[2]) / 3.0;
        for (const Vector3& point : {triangle[0], triangle[1], triangle[2], centre}) {
            largest = std::max(largest, to.nearest(point).squared_distance);
        }
    }
    return std::sqrt(largest);
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

double hausdorff_distance(std::span<const SpaceTriangle> first,
                          std::span<const SpaceTriangle> second) {
    const TriangleTree of_first({first.begin(), first.end()});
    const TriangleTree of_second({second.begin(), second.end()});
    return std::max(one_sided_distance(first, of_second), one_sided_distance(second, of_first));
}

}  // namespace couture::meshing
