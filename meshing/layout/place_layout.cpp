#include "meshing/layout/place_layout.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <queue>
#include <tuple>

#include "iga/core/error.h"
#include "meshing/layout/layout_region.h"
#include "meshing/layout/padded_ties.h"
#include "meshing/layout/tied_nodes.h"
#include "meshing/surface/surface_curves.h"

namespace couture::meshing {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
// Feature corners and curves take nodes that are nearer than this part of the node's shortest arc.
constexpr double reach = 0.7;
// Angle between the quads of an arc from which it counts as sharp.
constexpr double sharp_angle = std::numbers::pi / 9.0;
// An arc follows features if that is at most so many times as long as the straight line.
constexpr double longest_detour = 1.8;
// Interior angle of a wall at which two cuboids have corners as good as one has: beyond it
// sin(angle / 2), their scaled Jacobian, is larger than sin(angle).
constexpr double widest_corner = 2.0 * std::numbers::pi / 3.0;
// Of the box's diagonal: edges of the surface that arcs can run along.
constexpr double edge_part = 1.0 / 60.0;
// What it costs to be off an arc's straight line by its length, relative to the length.
constexpr double detour_weight = 4.0;

// Splits edges that are longer, the longest first, so that paths have vertices to run through.
void split_long_edges(SurfaceMesh& mesh, double longest) {
    std::priority_queue<std::pair<double, int>> queue;
    const auto offer = [&](EdgeHandle edge) {
        const double length = edge_length(mesh, edge);
        if (length > longest) queue.emplace(length, edge.idx());
    };
    for (const auto edge : mesh.edges()) offer(edge);
    while (!queue.empty()) {
        const auto [length, number] = queue.top();
        queue.pop();
        const EdgeHandle edge(number);
        if (edge_length(mesh, edge) != length) continue;
        const VertexHandle middle = split_edge(mesh, mesh.halfedge_handle(edge, 0));
        for (const auto e : mesh.ve_range(middle)) offer(e);
    }
}

// The next halfedge around the vertex where h starts, counter-clockwise.
HalfedgeHandle rotated(const SurfaceMesh& mesh, HalfedgeHandle h) {
    return mesh.opposite_halfedge_handle(mesh.prev_halfedge_handle(h));
}

Vector3 quad_normal(const std::array<Vector3, 4>& x) {
    return (x[2] - x[0]).cross(x[3] - x[1]).normalized();
}

// Distance of a point from a segment.
double distance_from(const Vector3& x, const Vector3& from, const Vector3& to) {
    const Vector3 d = to - from;
    const double squared = d.squaredNorm();
    const double t = squared > 0.0 ? std::clamp((x - from).dot(d) / squared, 0.0, 1.0) : 0.0;
    return (x - from - t * d).norm();
}

// Finds paths on the surface for arcs of the layout.
class Placer {
  public:
    Placer(SurfaceMesh& mesh, const QuadLayout& layout, std::vector<Vector3> positions)
        : mesh_(mesh),
          layout_(layout),
          positions_(std::move(positions)),
          node_vertex_(layout.n_nodes()),
          is_on_feature_(layout.n_nodes(), false),
          is_drawn_(layout.n_arcs(), false),
          reach_(layout.n_nodes(), infinity),
          normals_(layout.n_nodes(), Vector3::Zero()),
          n_sharp_(layout.n_nodes(), 0),
          arcs_at_(layout.n_nodes()) {
        for (const auto edge : mesh.edges()) mesh.data(edge).curve = -1;
        measure_layout();
    }

    // Ties along features.
    std::vector<LayoutTie> follow_features(const Features& features, double most_reach) {
        const double longest_edge = edge_part * bounding_box_diagonal(mesh_);
        split_long_edges(mesh_, longest_edge);
        for (double& r : reach_) r = std::min(r, std::max(most_reach, longest_edge));
        node_of_vertex_.assign(mesh_.n_vertices(), -1);
        place_on_corners(features);
        place_on_curves();
        draw_along_features();
        if (ties_.empty()) {
            throw TopologyError(
                "layout: no sharp edge of the surface runs along an arc of the layout; the "
                "layout's nodes must lie near the surface's corners and sharp edges, in the same "
                "units");
        }
        return std::move(ties_);
    }

    // Those and what else cuts the surface into discs.
    std::vector<LayoutTie> complete(std::vector<LayoutTie> ties) {
        const std::vector<VertexHandle> vertices = place_tied_nodes(mesh_, layout_, ties);
        node_of_vertex_.assign(mesh_.n_vertices(), -1);
        for (int node = 0; node < layout_.n_nodes(); ++node) {
            if (vertices[node].is_valid()) place(node, vertices[node]);
        }
        for (const LayoutTie& tie : ties) draw_tie(tie);
        split_chords();
        cut_into_discs();
        return std::move(ties_);
    }

  private:
    struct Path {
        std::vector<VertexHandle> vertices;
        double length = infinity;
    };
    using EdgeTest = std::function<bool(HalfedgeHandle)>;
    using EdgeCost = std::function<double(HalfedgeHandle)>;

    void measure_layout() {
        for (const auto& quad : layout_.quads()) {
            const Vector3 normal = normal_of(quad);
            for (const int node : quad) normals_[node] += normal;
        }
        for (int a = 0; a < layout_.n_arcs(); ++a) {
            const auto [from, to] = layout_.arcs()[a];
            const double length = (positions_[from] - positions_[to]).norm();
            for (const int node : {from, to}) {
                reach_[node] = std::min(reach_[node], reach * length);
                arcs_at_[node].push_back(a);
            }
            const auto& [left, right] = layout_.arc_quads(a);
            const double cosine =
                normal_of(layout_.quads()[left.quad]).dot(normal_of(layout_.quads()[right.quad]));
            if (cosine > std::cos(sharp_angle)) continue;
            ++n_sharp_[from];
            ++n_sharp_[to];
        }
    }

    [[nodiscard]] Vector3 normal_of(const std::array<int, 4>& quad) const {
        return quad_normal(
            {positions_[quad[0]], positions_[quad[1]], positions_[quad[2]], positions_[quad[3]]});
    }

    void place(int node, VertexHandle vertex) {
        node_vertex_[node] = vertex;
        node_of_vertex_[vertex.idx()] = node;
    }

    [[nodiscard]] int n_feature_edges(VertexHandle vertex) const {
        int n = 0;
        for (const auto edge : mesh_.ve_range(vertex)) n += is_feature(edge) ? 1 : 0;
        return n;
    }

    [[nodiscard]] bool is_feature(EdgeHandle edge) const { return mesh_.data(edge).feature >= 0; }

    // Whether the surface does not look the other way, as that across a thin wall does.
    [[nodiscard]] bool is_same_side(int node, VertexHandle vertex) const {
        return vertex_normal(mesh_, vertex).dot(normals_[node]) > 0.0;
    }

    // Pairs of vertices and nodes, the nearest first, one to one.
    void place_nearest(std::vector<std::tuple<double, int, int>> offers) {
        std::ranges::sort(offers);
        for (const auto& [distance, node, vertex] : offers) {
            if (node_vertex_[node].is_valid() || node_of_vertex_[vertex] >= 0) continue;
            place(node, VertexHandle(vertex));
            is_on_feature_[node] = true;
        }
    }

    void place_on_corners(const Features& features) {
        std::vector<std::tuple<double, int, int>> offers;
        for (const VertexHandle corner : features.corners) {
            const int degree = n_feature_edges(corner);
            if (degree < 2) continue;
            for (int node = 0; node < layout_.n_nodes(); ++node) {
                if (arcs_at_[node].empty() || !is_same_side(node, corner)) continue;
                const double d = (mesh_.point(corner) - positions_[node]).norm();
                if (d > reach_[node]) continue;
                offers.emplace_back(d * (1.0 + 0.5 * std::abs(degree - n_sharp_[node])), node,
                                    corner.idx());
            }
        }
        place_nearest(std::move(offers));
    }

    void place_on_curves() {
        std::vector<std::tuple<double, int, int>> offers;
        for (const auto vertex : mesh_.vertices()) {
            if (n_feature_edges(vertex) != 2 || node_of_vertex_[vertex.idx()] >= 0) continue;
            for (int node = 0; node < layout_.n_nodes(); ++node) {
                if (n_sharp_[node] < 2 || node_vertex_[node].is_valid()) continue;
                const double d = (mesh_.point(vertex) - positions_[node]).norm();
                if (d > reach_[node] || !is_same_side(node, vertex)) continue;
                offers.emplace_back(d, node, vertex.idx());
            }
        }
        place_nearest(std::move(offers));
    }

    [[nodiscard]] bool is_free(VertexHandle vertex) const {
        if (node_of_vertex_[vertex.idx()] >= 0) return false;
        return std::ranges::none_of(mesh_.ve_range(vertex), [&](const EdgeHandle edge) {
            return mesh_.data(edge).curve >= 0;
        });
    }

    // The halfedge at which the drawn arc of a node starts.
    [[nodiscard]] HalfedgeHandle start_of(int arc, int node) const {
        const auto& path = paths_.at(arc);
        const VertexHandle vertex = node_vertex_[node];
        return path.front() == vertex ? mesh_.find_halfedge(path[0], path[1])
                                      : mesh_.find_halfedge(path.back(), path[path.size() - 2]);
    }

    // Arcs around a node, counter-clockwise, from one on.
    [[nodiscard]] std::vector<int> fan_from(int arc, int node) const {
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

    // Whether a path of the arc may start with a halfedge: between the drawn arcs that are beside
    // it in the layout.
    [[nodiscard]] bool is_in_sector(int arc, int node, HalfedgeHandle h) const {
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

    // The cheapest way for an arc that starts at a node; to `end`, or to the reached free vertex of
    // least `end_cost`.
    [[nodiscard]] Path find_path(int arc, int node, VertexHandle end, const EdgeTest& may_take,
                                 const EdgeCost& cost,
                                 const std::function<double(VertexHandle)>& end_cost) const {
        const int other =
            layout_.arcs()[arc].from == node ? layout_.arcs()[arc].to : layout_.arcs()[arc].from;
        std::vector<double> distance(mesh_.n_vertices(), infinity);
        std::vector<HalfedgeHandle> arrival(mesh_.n_vertices());
        std::priority_queue<std::pair<double, int>, std::vector<std::pair<double, int>>,
                            std::greater<>>
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

    // Arc by arc.
    void draw_tie(const LayoutTie& tie) {
        auto start = tie.vertices.begin();
        for (std::size_t k = 0; k + 1 < tie.nodes.size(); ++k) {
            const auto end =
                std::find(start + 1, tie.vertices.end(), node_vertex_[tie.nodes[k + 1]]);
            const int from = tie.nodes[k];
            const int to = tie.nodes[k + 1];
            draw(layout_.find_arc(from, to), from, to,
                 {.vertices = {start, end + 1}, .length = 0.0}, tie.is_feature);
            start = end;
        }
    }

    void draw(int arc, int from, int to, Path path, bool is_on_feature) {
        LayoutTie tie{.vertices = path.vertices,
                      .nodes = {from, to},
                      .is_feature = is_on_feature,
                      .is_reflex = is_on_feature && is_blunt(path.vertices),
                      .name = fmt::format("arc of nodes {} and {}", from, to)};
        for (std::size_t k = 0; k + 1 < path.vertices.size(); ++k) {
            mesh_
                .data(
                    mesh_.edge_handle(mesh_.find_halfedge(path.vertices[k], path.vertices[k + 1])))
                .curve = arc;
        }
        is_drawn_[arc] = true;
        paths_[arc] = std::move(path.vertices);
        ties_.push_back(std::move(tie));
    }

    // Whether the solid fills more than the widest corner of one cuboid around a tenth of a path or
    // more.
    [[nodiscard]] bool is_blunt(const std::vector<VertexHandle>& path) const {
        constexpr double part = 0.1;
        double length = 0.0;
        double blunt_length = 0.0;
        for (std::size_t k = 0; k + 1 < path.size(); ++k) {
            const HalfedgeHandle h = mesh_.find_halfedge(path[k], path[k + 1]);
            const double l = edge_length(mesh_, mesh_.edge_handle(h));
            length += l;
            if (interior_angle(h) > widest_corner) blunt_length += l;
        }
        return blunt_length > part * length;
    }

    [[nodiscard]] double interior_angle(HalfedgeHandle h) const {
        const Vector3 left = face_normal(mesh_, mesh_.face_handle(h));
        const Vector3 right =
            face_normal(mesh_, mesh_.face_handle(mesh_.opposite_halfedge_handle(h)));
        const Vector3 along =
            mesh_.point(mesh_.to_vertex_handle(h)) - mesh_.point(mesh_.from_vertex_handle(h));
        return std::numbers::pi -
               std::atan2(left.cross(right).dot(along.normalized()), left.dot(right));
    }

    // Arcs between nodes on features, the straightest first.
    void draw_along_features() {
        const EdgeTest may_take = [&](HalfedgeHandle h) {
            return is_feature(mesh_.edge_handle(h));
        };
        std::vector<std::tuple<double, int>> offers;
        const auto path_of = [&](int arc) {
            const auto [from, to] = layout_.arcs()[arc];
            const EdgeCost cost = [&](HalfedgeHandle h) { return cost_near_line(h, from, to); };
            return find_path(arc, from, node_vertex_[to], may_take, cost, {});
        };
        const auto detour = [&](int arc, const Path& path) {
            const auto [from, to] = layout_.arcs()[arc];
            return path.length /
                   (mesh_.point(node_vertex_[from]) - mesh_.point(node_vertex_[to])).norm();
        };
        for (int a = 0; a < layout_.n_arcs(); ++a) {
            const auto [from, to] = layout_.arcs()[a];
            if (!is_on_feature_[from] || !is_on_feature_[to]) continue;
            const double d = detour(a, path_of(a));
            if (d <= longest_detour) offers.emplace_back(d, a);
        }
        std::ranges::sort(offers);
        for (const auto& [old_detour, a] : offers) {
            const auto [from, to] = layout_.arcs()[a];
            Path path = path_of(a);
            if (detour(a, path) > longest_detour) continue;
            draw(a, from, to, std::move(path), true);
        }
    }

    [[nodiscard]] double cost_near_line(HalfedgeHandle h, int from, int to) const {
        const Vector3 start = mesh_.point(node_vertex_[from]);
        const Vector3 end =
            node_vertex_[to].is_valid() ? mesh_.point(node_vertex_[to]) : positions_[to];
        const Vector3 a = mesh_.point(mesh_.from_vertex_handle(h));
        const Vector3 b = mesh_.point(mesh_.to_vertex_handle(h));
        const double off = distance_from(0.5 * (a + b), start, end) / (end - start).norm();
        return (b - a).norm() * (1.0 + detour_weight * off);
    }

    void split_chords() {
        split_chords_between_curves(mesh_);
        node_of_vertex_.resize(mesh_.n_vertices(), -1);
    }

    // Joins boundary loops of regions by the shortest ways of fewest arcs.
    void cut_into_discs() {
        std::vector<LayoutRegion> open = layout_regions(layout_, is_drawn_);
        while (!open.empty()) {
            const LayoutRegion region = std::move(open.back());
            open.pop_back();
            if (region.loops().size() < 2) continue;
            const LayoutRegion::Path* best = nullptr;
            double shortest = infinity;
            const std::vector<LayoutRegion::Path> ways = region.paths_between_loops();
            for (const LayoutRegion::Path& way : ways) {
                double length = 0.0;
                for (std::size_t k = 0; k + 1 < way.size(); ++k) {
                    length +=
                        (positions_[region.node(way[k])] - positions_[region.node(way[k + 1])])
                            .norm();
                }
                if (length >= shortest) continue;
                shortest = length;
                best = &way;
            }
            if (best == nullptr) {
                throw TopologyError("layout: no arcs join two boundary loops of a region");
            }
            for (std::size_t k = 0; k + 1 < best->size(); ++k) {
                draw_straight(region.node((*best)[k]), region.node((*best)[k + 1]));
            }
            for (LayoutRegion& part : region.parts(is_drawn_)) open.push_back(std::move(part));
        }
    }

    void draw_straight(int from, int to) {
        const int arc = layout_.find_arc(from, to);
        const EdgeTest may_take = [](HalfedgeHandle) { return true; };
        const EdgeCost cost = [&](HalfedgeHandle h) { return cost_near_line(h, from, to); };
        const auto end_cost = [&](VertexHandle v) {
            const double d = (mesh_.point(v) - positions_[to]).norm();
            return d * (2.0 - vertex_normal(mesh_, v).dot(normals_[to].normalized()));
        };
        Path path = find_path(arc, from, node_vertex_[to], may_take, cost, end_cost);
        if (path.vertices.size() < 2) {
            throw GeometryError(
                "layout: there is no way for the arc of nodes {} and {} on the surface, between "
                "the "
                "arcs beside it; do its nodes lie near the surface?",
                from, to);
        }
        if (!node_vertex_[to].is_valid()) place(to, path.vertices.back());
        draw(arc, from, to, std::move(path), false);
        split_chords();
    }

    SurfaceMesh& mesh_;
    const QuadLayout& layout_;
    const std::vector<Vector3> positions_;
    std::vector<VertexHandle> node_vertex_;
    std::vector<int> node_of_vertex_;
    std::vector<bool> is_on_feature_;
    std::vector<bool> is_drawn_;
    // How far from a node features may lie that it is placed on.
    std::vector<double> reach_;
    std::vector<Vector3> normals_;
    // Sharp arcs of each node.
    std::vector<int> n_sharp_;
    std::vector<std::vector<int>> arcs_at_;
    std::map<int, std::vector<VertexHandle>> paths_;
    std::vector<LayoutTie> ties_;
};

// Nodes in the place of old ones lie there; others on the boundary amid their neighbours.
std::vector<Vector3> padded_positions(const std::vector<Vector3>& positions,
                                      const std::vector<int>& node_in_place,
                                      const QuadLayout& boundary) {
    std::vector<Vector3> padded(boundary.n_nodes(), Vector3::Zero());
    std::vector<bool> is_known(boundary.n_nodes(), false);
    for (std::size_t n = 0; n < node_in_place.size(); ++n) {
        padded[node_in_place[n]] = positions[n];
        is_known[node_in_place[n]] = true;
    }
    constexpr int n_sweeps = 100;
    const std::vector<int> valences = boundary.valences();
    for (int sweep = 0; sweep < n_sweeps; ++sweep) {
        std::vector<Vector3> sums(boundary.n_nodes(), Vector3::Zero());
        for (const QuadLayout::Arc& arc : boundary.arcs()) {
            sums[arc.from] += padded[arc.to];
            sums[arc.to] += padded[arc.from];
        }
        for (int n = 0; n < boundary.n_nodes(); ++n) {
            if (!is_known[n] && valences[n] > 0) padded[n] = sums[n] / valences[n];
        }
    }
    return padded;
}

}  // namespace

CuboidDecomposition place_layout(const SurfaceMesh& mesh, const Features& features,
                                 const PlacedLayout& placed, double most_reach) {
    const LayoutBoundary boundary = layout_boundary(placed.layout);
    const int chi = static_cast<int>(mesh.n_vertices()) - static_cast<int>(mesh.n_edges()) +
                    static_cast<int>(mesh.n_faces());
    if (boundary.layout.euler_characteristic() != chi) {
        throw TopologyError(
            "layout: its boundary has Euler characteristic {}, the surface {}; they must have the "
            "same genus",
            boundary.layout.euler_characteristic(), chi);
    }
    CuboidDecomposition result;
    result.mesh = mesh;
    std::vector<LayoutTie> feature_ties =
        Placer(result.mesh, boundary.layout, placed.positions).follow_features(features, most_reach);
    // Nodes on features stay: on a closed curve nothing else keeps them from turning away from
    // those of the other side of a wall.
    std::vector<bool> is_held(result.mesh.n_vertices(), false);
    for (const LayoutTie& tie : feature_ties) {
        is_held[tie.vertices.front().idx()] = true;
        is_held[tie.vertices.back().idx()] = true;
    }
    PaddedTies padded = pad_with_ties(placed.layout, std::move(feature_ties));
    const QuadLayout outside = layout_boundary(padded.volume).layout;
    const std::vector<LayoutTie> ties =
        Placer(result.mesh, outside,
               padded_positions(placed.positions, padded.node_in_place, outside))
            .complete(std::move(padded.ties));
    draw_decomposition(std::move(padded.volume), ties, result);
    for (std::size_t n = 0; n < result.surface.nodes.size(); ++n) {
        const int vertex = result.surface.nodes[n].idx();
        if (vertex >= 0 && vertex < static_cast<int>(is_held.size()) && is_held[vertex]) {
            result.surface.is_corner_node[n] = true;
        }
    }
    return result;
}

double untied_length(const CuboidDecomposition& decomposition) {
    double length = 0.0;
    for (const auto edge : decomposition.mesh.edges()) {
        const auto& data = decomposition.mesh.data(edge);
        if (data.feature >= 0 && data.curve < 0) length += edge_length(decomposition.mesh, edge);
    }
    return length;
}

}  // namespace couture::meshing
