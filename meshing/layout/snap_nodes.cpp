#include "meshing/layout/snap_nodes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "iga/core/error.h"
#include "meshing/surface/triangle_tree.h"

namespace couture::meshing {

namespace {

std::string coordinates(const Vector3& x) {
    return fmt::format("({:.6g}, {:.6g}, {:.6g})", x.x(), x.y(), x.z());
}

// A place of a feature curve.
struct CurvePlace {
    double distance = std::numeric_limits<double>::infinity();
    HalfedgeHandle halfedge = HalfedgeHandle();
    // Of the way along the halfedge.
    double fraction = 0.0;
};

TriangleTree make_tree(const SurfaceMesh& mesh) {
    std::vector<std::array<Vector3, 3>> triangles;
    for (const auto face : mesh.faces()) {
        const auto [a, b, c] = face_vertices(mesh, face);
        triangles.push_back({mesh.point(a), mesh.point(b), mesh.point(c)});
    }
    return TriangleTree(std::move(triangles));
}

VertexHandle nearest_corner(const SurfaceMesh& mesh, const Features& features, const Vector3& x) {
    VertexHandle nearest;
    double least = std::numeric_limits<double>::infinity();
    for (const VertexHandle corner : features.corners) {
        const double distance = (mesh.point(corner) - x).norm();
        if (distance >= least) continue;
        least = distance;
        nearest = corner;
    }
    return nearest;
}

CurvePlace nearest_on_curves(const SurfaceMesh& mesh, const Vector3& x) {
    CurvePlace nearest;
    for (const auto edge : mesh.edges()) {
        if (mesh.data(edge).feature < 0) continue;
        const HalfedgeHandle h = mesh.halfedge_handle(edge, 0);
        const Vector3 from = mesh.point(mesh.from_vertex_handle(h));
        const Vector3 d = mesh.point(mesh.to_vertex_handle(h)) - from;
        const double fraction = std::clamp((x - from).dot(d) / d.squaredNorm(), 0.0, 1.0);
        const double distance = (x - from - fraction * d).norm();
        if (distance < nearest.distance) nearest = {distance, h, fraction};
    }
    return nearest;
}

// An end of the edge that is all but there, or a new vertex.
VertexHandle vertex_at(SurfaceMesh& mesh, const CurvePlace& place) {
    constexpr double near_end = 0.01;
    if (place.fraction < near_end) return mesh.from_vertex_handle(place.halfedge);
    if (place.fraction > 1.0 - near_end) return mesh.to_vertex_handle(place.halfedge);
    return split_edge(mesh, place.halfedge, place.fraction);
}

// Where a node comes to a feature.
std::optional<Vector3> feature_place(SurfaceMesh& mesh, const Features& features, const Vector3& x,
                                     double tolerance) {
    const VertexHandle corner = nearest_corner(mesh, features, x);
    if (corner.is_valid() && (mesh.point(corner) - x).norm() <= tolerance) {
        return mesh.point(corner);
    }
    const CurvePlace on_curve = nearest_on_curves(mesh, x);
    if (on_curve.distance > tolerance) return {};
    return mesh.point(vertex_at(mesh, on_curve));
}

void check_apart(const PlacedLayout& placed, const std::vector<bool>& is_outer,
                 const std::vector<std::string>& names, double size) {
    constexpr double same = 1e-9;
    for (int n = 0; n < placed.layout.n_nodes; ++n) {
        for (int other = 0; other < n; ++other) {
            if (!is_outer[n] || !is_outer[other]) continue;
            if ((placed.positions[n] - placed.positions[other]).norm() > same * size) continue;
            throw InputError(
                "layout: nodes '{}' and '{}' both come to {} on the surface; each must have a "
                "place of its own: move one of them, or lower 'tolerance'",
                names[other], names[n], coordinates(placed.positions[n]));
        }
    }
}

}  // namespace

PlacedLayout snap_nodes(SurfaceMesh& mesh, const Features& features, PlacedLayout placed,
                        const std::vector<std::string>& names, double tolerance) {
    if (!(tolerance > 0.0) || !std::isfinite(tolerance)) {
        throw InputError("layout: tolerance {}; it must be positive", tolerance);
    }
    std::vector<bool> is_outer(placed.layout.n_nodes, false);
    const LayoutBoundary boundary = layout_boundary(placed.layout);
    for (const auto& quad : boundary.layout.quads()) {
        for (const int node : quad) is_outer[node] = true;
    }
    const TriangleTree tree = make_tree(mesh);
    for (int n = 0; n < placed.layout.n_nodes; ++n) {
        if (!is_outer[n]) continue;
        Vector3& x = placed.positions[n];
        const NearestPlace on_surface = tree.nearest(x);
        const double distance = std::sqrt(on_surface.squared_distance);
        if (distance > tolerance) {
            throw InputError(
                "layout: node '{}' at {} lies {:.3g} from the surface, which is more than "
                "'tolerance' = {:.3g}; the nearest place is {}: move the node, or raise the "
                "tolerance",
                names[n], coordinates(x), distance, tolerance, coordinates(on_surface.point));
        }
        x = feature_place(mesh, features, x, tolerance).value_or(on_surface.point);
    }
    check_apart(placed, is_outer, names, bounding_box_diagonal(mesh));
    return placed;
}

}  // namespace couture::meshing
