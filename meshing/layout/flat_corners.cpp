#include "meshing/layout/flat_corners.h"

#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <numbers>

namespace couture::meshing {

namespace {

constexpr double flat_angle = 150.0 / 180.0 * std::numbers::pi;

// Of the surface at a vertex, counter-clockwise from one halfedge that starts there to another.
double angle_between(const SurfaceMesh& mesh, HalfedgeHandle from, HalfedgeHandle to) {
    const Vector3& centre = mesh.point(mesh.from_vertex_handle(from));
    double sum = 0.0;
    HalfedgeHandle h = from;
    do {
        const HalfedgeHandle next = mesh.opposite_halfedge_handle(mesh.prev_halfedge_handle(h));
        const Vector3 a = mesh.point(mesh.to_vertex_handle(h)) - centre;
        const Vector3 b = mesh.point(mesh.to_vertex_handle(next)) - centre;
        sum += std::atan2(a.cross(b).norm(), a.dot(b));
        h = next;
    } while (h != to && h != from);
    return sum;
}

}  // namespace

FlatCorners flat_corners(const SurfaceMesh& mesh, const LayoutBoundary& boundary,
                         std::span<const LayoutTie> ties) {
    const QuadLayout& layout = boundary.layout;
    FlatCorners flat;
    flat.parts_faces.assign(layout.n_arcs(), false);
    // By an arc and the node that it starts at.
    std::map<std::pair<int, int>, HalfedgeHandle> starts;
    for (const LayoutTie& tie : ties) {
        const int arc = layout.find_arc(tie.nodes.front(), tie.nodes.back());
        flat.parts_faces[arc] = tie.is_feature;
        const auto& path = tie.vertices;
        starts[{arc, tie.nodes.front()}] = mesh.find_halfedge(path[0], path[1]);
        starts[{arc, tie.nodes.back()}] = mesh.find_halfedge(path.back(), path[path.size() - 2]);
    }
    for (int q = 0; q < layout.n_quads(); ++q) {
        for (int k = 0; k < 4; ++k) {
            const int node = layout.quads()[q][k];
            const auto out = starts.find({layout.sides(q)[k].arc, node});
            const auto in = starts.find({layout.sides(q)[(k + 3) % 4].arc, node});
            if (out == starts.end() || in == starts.end()) continue;
            if (angle_between(mesh, out->second, in->second) < flat_angle) continue;
            flat.corners.push_back({boundary.sides[q], node});
        }
    }
    return flat;
}

}  // namespace couture::meshing
