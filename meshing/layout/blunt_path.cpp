#include "meshing/layout/blunt_path.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace couture::meshing {

namespace {

// Of the length: less than this does not count.
constexpr double smallest_part = 0.1;

// Of the solid around a halfedge.
double interior_angle(const SurfaceMesh& mesh, HalfedgeHandle h) {
    const Vector3 left = face_normal(mesh, mesh.face_handle(h));
    const Vector3 right = face_normal(mesh, mesh.face_handle(mesh.opposite_halfedge_handle(h)));
    const Vector3 along =
        mesh.point(mesh.to_vertex_handle(h)) - mesh.point(mesh.from_vertex_handle(h));
    return std::numbers::pi -
           std::atan2(left.cross(right).dot(along.normalized()), left.dot(right));
}

// The least of values with their lengths, but for the smallest part of the length.
double least_of_most(std::vector<std::pair<double, double>> values, double length) {
    std::ranges::sort(values);
    double worst_length = 0.0;
    for (const auto& [value, l] : values) {
        worst_length += l;
        if (worst_length > smallest_part * length) return value;
    }
    return 1.0;
}

}  // namespace

bool is_blunt(const SurfaceMesh& mesh, std::span<const VertexHandle> path) {
    double length = 0.0;
    std::vector<std::pair<double, double>> of_one;
    std::vector<std::pair<double, double>> of_two;
    for (std::size_t k = 0; k + 1 < path.size(); ++k) {
        const HalfedgeHandle h = mesh.find_halfedge(path[k], path[k + 1]);
        const double l = edge_length(mesh, mesh.edge_handle(h));
        length += l;
        if (mesh.is_boundary(mesh.edge_handle(h))) continue;
        const double angle = interior_angle(mesh, h);
        of_one.emplace_back(std::sin(angle), l);
        of_two.emplace_back(std::sin(0.5 * angle), l);
    }
    return least_of_most(std::move(of_two), length) > least_of_most(std::move(of_one), length);
}

}  // namespace couture::meshing
