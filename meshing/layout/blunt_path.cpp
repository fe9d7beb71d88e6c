#include "meshing/layout/blunt_path.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace couture::meshing {

namespace {

constexpr double widest_corner = 2.0 * std::numbers::pi / 3.0;
constexpr double largest_part = 0.1;

// Of the solid around a halfedge.
double interior_angle(const SurfaceMesh& mesh, HalfedgeHandle h) {
    const Vector3 left = face_normal(mesh, mesh.face_handle(h));
    const Vector3 right = face_normal(mesh, mesh.face_handle(mesh.opposite_halfedge_handle(h)));
    const Vector3 along =
        mesh.point(mesh.to_vertex_handle(h)) - mesh.point(mesh.from_vertex_handle(h));
    return std::numbers::pi -
           std::atan2(left.cross(right).dot(along.normalized()), left.dot(right));
}

}  // namespace

bool is_blunt(const SurfaceMesh& mesh, std::span<const VertexHandle> path) {
    double length = 0.0;
    double blunt_length = 0.0;
    for (std::size_t k = 0; k + 1 < path.size(); ++k) {
        const HalfedgeHandle h = mesh.find_halfedge(path[k], path[k + 1]);
        const double l = edge_length(mesh, mesh.edge_handle(h));
        length += l;
        if (mesh.is_boundary(mesh.edge_handle(h))) continue;
        if (interior_angle(mesh, h) > widest_corner) blunt_length += l;
    }
    return blunt_length > largest_part * length;
}

}  // namespace couture::meshing
