#include "meshing/layout/arc_paths.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <queue>

#include "meshing/layout/blunt_path.h"
#include "meshing/surface/surface_curves.h"

namespace couture::meshing {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
// What it costs to be off an arc's straight line by its length, relative to the length.
constexpr double detour_weight = 4.0;

// The next halfedge around the vertex where h starts, counter-clockwise.
HalfedgeHandle rotated(const SurfaceMesh& mesh, HalfedgeHandle h) {
    return mesh.opposite_halfedge_handle(mesh.prev_halfedge_handle(h));
}

// Distance of a point from a segment.
double distance_from(const Vector3& x, const Vector3& from, const Vector3& to) {
    const Vector3 d = to - from;
    const double squared = d.squaredNorm();
    const double t = squared > 0.0 ? std::clamp((x - from).dot(d) / squared, 0.0, 1.0) : 0.0;
    return (x - from - t * d).norm();
}

}  // namespace

ArcPaths::ArcPaths(SurfaceMesh& mesh, const QuadLayout& layout)
    : mesh_(mesh),
      layout_(layout),
      node_vertex_(layout.n_nodes()),
      node_of_vertex_(mesh.n_vertices(), -1),
      is_drawn_(layout.n_arcs(), false) {
    for (const auto edge : mesh.edges()) mesh.data(edge).curve = -1;
}

void ArcPaths::place(int node, VertexHandle vertex) {
    node_vertex_[node] = vertex;
    node_of_vertex_[vertex.idx()] = node;
}

bool ArcPaths::is_free(VertexHandle vertex) const {
    return !has_node(vertex) && std::ranges::none_of(mesh_.ve_range(vertex), [&](EdgeHandle edge) {
        return mesh_.data(edge).curve >= 0;
    });
}

// The halfedge at which the drawn arc of a node starts.
HalfedgeHandle ArcPaths::start_of(int arc, int node) const {
    const auto& path = paths_.at(arc);
    const VertexHandle vertex = node_vertex_[node];
    return path.front() == vertex ? mesh_.find_halfedge(path[0], path[1])
                                  : mesh_.find_halfedge(path.back(), path[path.size() - 2]);
}

// Arcs around a node, counter-clockwise, from one on.
std::vector<int> ArcPaths::fan_from(int arc, int node) const {
    std::vector<int> fan{arc};
    while (true) {
        const int last = fan.back();
        // The quad left of the arc as it leaves the node.
        const bool leaves = layout_.arcs()[last].from == node;
        const QuadLayout::ArcQuad place = layout_.arc_quads(last)[leaves ? 0 : 1];
        const int next = layout_.sides(place.quad)[(place.side + 3) % 4].arc;
        if (next == arc) return fan;
        fan.push_back(next);
    }
}

// Whether a path of the arc may start with a halfedge: between the drawn arcs that are beside it in
// the layout.
bool ArcPaths::is_in_sector(int arc, int node, HalfedgeHandle h) const {
    const std::vector<int> fan = fan_from(arc, node);
    const auto is_drawn = [&](int a) { return is_drawn_[a]; };
    const auto next = std::find_if(fan.begin() + 1, fan.end(), is_drawn);
    if (next == fan.end()) return true;
    const auto before = std::find_if(fan.rbegin(), fan.rend() - 1, is_drawn);
    const HalfedgeHandle first = start_of(*before, node);
    const HalfedgeHandle last = start_of(*next, node);
    for (HalfedgeHandle g = rotated(mesh_, first); g != last; g = rotated(mesh_, g)) {
        if (g == h) return true;
        if (g == first) break;
    }
    return false;
}

ArcPaths::Path ArcPaths::find(int arc, int node, VertexHandle end, const EdgeTest& may_take,
                              const EdgeCost& cost, const EndCost& end_cost) const {
    const int other =
        layout_.arcs()[arc].from == node ? layout_.arcs()[arc].to : layout_.arcs()[arc].from;
    std::vector<double> distance(mesh_.n_vertices(), infinity);
    std::vector<HalfedgeHandle> arrival(mesh_.n_vertices());
    std::priority_queue<std::pair<double, int>, std::vector<std::pair<double, int>>, std::greater<>>
        queue;
    const VertexHandle start = node_vertex_[node];
    distance[start.idx()] = 0.0;
    queue.emplace(0.0, start.idx());
    VertexHandle best = end;
    double best_cost = infinity;
    while (!queue.empty()) {
        const auto [d, number] = queue.top();
        queue.pop();
        if (d > distance[number]) continue;
        const VertexHandle here(number);
        if (here == end) break;
        if (!end.is_valid() && here != start && end_cost(here) < best_cost) {
            best = here;
            best_cost = end_cost(here);
        }
        for (const auto h : mesh_.voh_range(here)) {
            const VertexHandle next = mesh_.to_vertex_handle(h);
            if (!may_take(h) || mesh_.data(mesh_.edge_handle(h)).curve >= 0) continue;
            if (next != end && !is_free(next)) continue;
            if (here == start && !is_in_sector(arc, node, h)) continue;
            if (next == end && !is_in_sector(arc, other, mesh_.opposite_halfedge_handle(h))) {
                continue;
            }
            const double there = d + cost(h);
            if (there >= distance[next.idx()]) continue;
            distance[next.idx()] = there;
            arrival[next.idx()] = h;
            queue.emplace(there, next.idx());
        }
    }
    Path path;
    if (!best.is_valid() || !arrival[best.idx()].is_valid()) return path;
    path.length = 0.0;
    path.vertices = {best};
    while (path.vertices.back() != start) {
        const HalfedgeHandle h = arrival[path.vertices.back().idx()];
        path.length += edge_length(mesh_, mesh_.edge_handle(h));
        path.vertices.push_back(mesh_.from_vertex_handle(h));
    }
    std::ranges::reverse(path.vertices);
    return path;
}

void ArcPaths::draw(int from, int to, std::vector<VertexHandle> path, bool is_feature) {
    const int arc = layout_.find_arc(from, to);
    ties_.push_back({.vertices = path,
                     .nodes = {from, to},
                     .is_feature = is_feature,
                     .is_blunt = is_feature && is_blunt(mesh_, path),
                     .name = fmt::format("arc of nodes {} and {}", from, to)});
    for (std::size_t k = 0; k + 1 < path.size(); ++k) {
        const HalfedgeHandle h = mesh_.find_halfedge(path[k], path[k + 1]);
        mesh_.data(mesh_.edge_handle(h)).curve = arc;
    }
    is_drawn_[arc] = true;
    paths_[arc] = std::move(path);
}

void ArcPaths::draw(const LayoutTie& tie) {
    auto start = tie.vertices.begin();
    for (std::size_t k = 0; k + 1 < tie.nodes.size(); ++k) {
        const auto end = std::find(start + 1, tie.vertices.end(), vertex(tie.nodes[k + 1]));
        draw(tie.nodes[k], tie.nodes[k + 1], {start, end + 1}, tie.is_feature);
        start = end;
    }
}

void ArcPaths::split_chords() {
    split_chords_between_curves(mesh_);
    node_of_vertex_.resize(mesh_.n_vertices(), -1);
}

ArcPaths::EdgeCost cost_near_line(const SurfaceMesh& mesh, const Vector3& start,
                                  const Vector3& end) {
    return [&mesh, start, end](HalfedgeHandle h) {
        const Vector3 a = mesh.point(mesh.from_vertex_handle(h));
        const Vector3 b = mesh.point(mesh.to_vertex_handle(h));
        const double off = distance_from(0.5 * (a + b), start, end) / (end - start).norm();
        return (b - a).norm() * (1.0 + detour_weight * off);
    };
}

std::vector<Vector3> node_normals(const QuadLayout& layout, const std::vector<Vector3>& positions) {
    std::vector<Vector3> normals(layout.n_nodes(), Vector3::Zero());
    for (const auto& quad : layout.quads()) {
        const Vector3 normal = quad_normal(quad, positions);
        for (const int node : quad) normals[node] += normal;
    }
    return normals;
}

Vector3 quad_normal(const std::array<int, 4>& quad, const std::vector<Vector3>& positions) {
    const auto& [a, b, c, d] = quad;
    return (positions[c] - positions[a]).cross(positions[d] - positions[b]).normalized();
}

}  // namespace couture::meshing
