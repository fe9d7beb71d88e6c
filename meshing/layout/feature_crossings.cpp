#include "meshing/layout/feature_crossings.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <set>
#include <utility>

#include "meshing/surface/triangle_tree.h"

namespace couture::meshing {

namespace {

// Numbers of the smooth faces at each node.
using NodeRegions = std::vector<std::set<int>>;
// Features without arcs by the two smooth faces beside them.
using FreeFeatures = std::map<std::pair<int, int>, std::vector<EdgeHandle>>;

std::pair<int, int> regions_beside(const SurfaceMesh& mesh, EdgeHandle edge) {
    const int left = mesh.data(mesh.face_handle(mesh.halfedge_handle(edge, 0))).region;
    const int right = mesh.data(mesh.face_handle(mesh.halfedge_handle(edge, 1))).region;
    return std::minmax(left, right);
}

// Whether no arc runs along a feature edge between two smooth faces.
bool is_free_feature(const SurfaceMesh& mesh, EdgeHandle edge) {
    if (mesh.data(edge).feature < 0 || mesh.data(edge).curve >= 0) return false;
    const auto [left, right] = regions_beside(mesh, edge);
    return left != right;
}

FreeFeatures find_free_features(const SurfaceMesh& mesh) {
    FreeFeatures features;
    for (const auto edge : mesh.edges()) {
        if (is_free_feature(mesh, edge)) features[regions_beside(mesh, edge)].push_back(edge);
    }
    return features;
}

NodeRegions find_node_regions(const SurfaceMesh& mesh, const QuadLayout& layout,
                              const std::vector<Vector3>& positions,
                              const std::vector<LayoutTie>& ties) {
    NodeRegions regions(layout.n_nodes());
    for (const LayoutTie& tie : ties) {
        for (const auto& [node, vertex] : {std::pair(tie.nodes.front(), tie.vertices.front()),
                                           std::pair(tie.nodes.back(), tie.vertices.back())}) {
            for (const auto face : mesh.vf_range(vertex)) {
                regions[node].insert(mesh.data(face).region);
            }
        }
    }
    std::vector<std::array<Vector3, 3>> triangles;
    for (const auto face : mesh.faces()) {
        const auto [a, b, c] = face_vertices(mesh, face);
        triangles.push_back({mesh.point(a), mesh.point(b), mesh.point(c)});
    }
    const TriangleTree tree(std::move(triangles));
    const std::vector<int> valences = layout.valences();
    for (int node = 0; node < layout.n_nodes(); ++node) {
        if (valences[node] == 0 || !regions[node].empty()) continue;
        const FaceHandle nearest(tree.nearest(positions[node]).triangle);
        regions[node].insert(mesh.data(nearest).region);
    }
    return regions;
}

// Places of an edge and of a line that are nearest to each other.
struct LinePlace {
    Vector3 on_edge;
    double distance = std::numeric_limits<double>::infinity();
};

LinePlace nearest_to_line(const SurfaceMesh& mesh, EdgeHandle edge, const Vector3& start,
                          const Vector3& end) {
    const HalfedgeHandle h = mesh.halfedge_handle(edge, 0);
    const Vector3& from = mesh.point(mesh.from_vertex_handle(h));
    const Vector3& to = mesh.point(mesh.to_vertex_handle(h));
    LinePlace nearest;
    constexpr int n_steps = 4;
    for (int i = 0; i <= n_steps; ++i) {
        const double part = static_cast<double>(i) / n_steps;
        const Vector3 x = (1.0 - part) * from + part * to;
        const Vector3 d = end - start;
        const double t = std::clamp((x - start).dot(d) / d.squaredNorm(), 0.0, 1.0);
        const double distance = (x - start - t * d).norm();
        if (distance < nearest.distance) nearest = {x, distance};
    }
    return nearest;
}

// Where an arc crosses a feature between the smooth faces of its ends.
std::optional<Vector3> crossing_between(const SurfaceMesh& mesh, const FreeFeatures& features,
                                        const std::set<int>& first, const std::set<int>& second,
                                        const Vector3& start, const Vector3& end) {
    LinePlace nearest;
    for (const int a : first) {
        if (second.contains(a)) return {};
        for (const int b : second) {
            const auto found = features.find(std::minmax(a, b));
            if (found == features.end()) continue;
            for (const EdgeHandle edge : found->second) {
                const LinePlace place = nearest_to_line(mesh, edge, start, end);
                if (place.distance < nearest.distance) nearest = place;
            }
        }
    }
    // Features on other sides of the same smooth faces are not meant.
    constexpr double most_bulge = 0.5;
    if (nearest.distance > most_bulge * (end - start).norm()) return {};
    return nearest.on_edge;
}

// Where a feature ends at an arc that runs along another one: nearest to the arc's middle.
std::optional<Vector3> end_on_tie(const SurfaceMesh& mesh, const LayoutTie& tie) {
    const Vector3 middle =
        0.5 * (mesh.point(tie.vertices.front()) + mesh.point(tie.vertices.back()));
    std::optional<Vector3> nearest;
    for (std::size_t k = 1; k + 1 < tie.vertices.size(); ++k) {
        const Vector3& x = mesh.point(tie.vertices[k]);
        const auto is_free = [&](EdgeHandle edge) { return is_free_feature(mesh, edge); };
        if (std::ranges::none_of(mesh.ve_range(tie.vertices[k]), is_free)) continue;
        if (!nearest || (x - middle).norm() < (*nearest - middle).norm()) nearest = x;
    }
    return nearest;
}

// Leaves out sheets of the boundary where a feature turns in a quad, from one side to the next: the
// small quad at its corner there would be a triangle.
void forget_turns(const QuadLayout& layout, std::vector<std::optional<Vector3>>& crossings) {
    const std::vector<int> sheets = layout.sheets();
    std::set<int> turning;
    for (int q = 0; q < layout.n_quads(); ++q) {
        for (int k = 0; k < 4; ++k) {
            const auto arc = [&](int i) { return layout.sides(q)[(k + i) % 4].arc; };
            if (!crossings[arc(0)] || !crossings[arc(1)]) continue;
            if (crossings[arc(2)] || crossings[arc(3)]) continue;
            turning.insert(sheets[arc(0)]);
            turning.insert(sheets[arc(1)]);
        }
    }
    for (int a = 0; a < layout.n_arcs(); ++a) {
        if (turning.contains(sheets[a])) crossings[a].reset();
    }
}

}  // namespace

EdgePlaces feature_crossings(const SurfaceMesh& mesh, const QuadLayout& layout,
                             const std::vector<Vector3>& positions,
                             const std::vector<LayoutTie>& ties) {
    const FreeFeatures features = find_free_features(mesh);
    if (features.empty()) return {};
    const NodeRegions regions = find_node_regions(mesh, layout, positions, ties);
    std::vector<std::optional<Vector3>> crossings;
    for (const auto& [from, to] : layout.arcs()) {
        crossings.push_back(crossing_between(mesh, features, regions[from], regions[to],
                                             positions[from], positions[to]));
    }
    for (const LayoutTie& tie : ties) {
        crossings[layout.find_arc(tie.nodes.front(), tie.nodes.back())] = end_on_tie(mesh, tie);
    }
    forget_turns(layout, crossings);
    EdgePlaces places;
    for (int q = 0; q < layout.n_quads(); ++q) {
        for (const int k : {0, 1}) {
            const std::array<int, 2> arcs = {layout.sides(q)[k].arc, layout.sides(q)[k + 2].arc};
            if (!crossings[arcs[0]] || !crossings[arcs[1]]) continue;
            for (const int arc : arcs) {
                const auto& [from, to] = layout.arcs()[arc];
                places.insert({{from, to}, *crossings[arc]});
            }
        }
    }
    return places;
}

}  // namespace couture::meshing
