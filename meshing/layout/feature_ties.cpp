#include "meshing/layout/feature_ties.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <queue>
#include <tuple>

namespace couture::meshing {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
// Feature corners and curves take nodes that are nearer than this part of the node's shortest arc.
constexpr double reach = 0.7;
// Angle between the quads of an arc from which it counts as sharp.
constexpr double sharp_angle = std::numbers::pi / 9.0;
// An arc follows features if that is at most so many times as long as the straight line.
constexpr double longest_detour = 1.8;
// Of the box's diagonal: edges of the surface that arcs can run along.
constexpr double edge_part = 1.0 / 60.0;

// Of the box's diagonal: what lies no farther apart is at the same place.
constexpr double same_place = 1e-9;

// Distance of a feature from a node, node, vertex of the feature.
using Offer = std::tuple<double, int, int>;

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

int n_feature_edges(const SurfaceMesh& mesh, VertexHandle vertex) {
    int n = 0;
    for (const auto edge : mesh.ve_range(vertex)) n += mesh.data(edge).feature >= 0 ? 1 : 0;
    return n;
}

// The way for an arc along features, and its length over that of the straight line.
std::pair<ArcPaths::Path, double> way_along_features(const SurfaceMesh& mesh,
                                                     const QuadLayout& layout,
                                                     const ArcPaths& paths, int arc) {
    const auto [from, to] = layout.arcs()[arc];
    const Vector3& start = mesh.point(paths.vertex(from));
    const Vector3& end = mesh.point(paths.vertex(to));
    const auto is_feature = [&](HalfedgeHandle h) {
        return mesh.data(mesh.edge_handle(h)).feature >= 0;
    };
    ArcPaths::Path path =
        paths.find(arc, from, paths.vertex(to), is_feature, cost_near_line(mesh, start, end));
    const double detour = path.length / (end - start).norm();
    return {std::move(path), detour};
}

// Draws those of the arcs that can follow features, the straightest first.
void draw_along_features(const SurfaceMesh& mesh, const QuadLayout& layout,
                         const std::vector<int>& arcs, ArcPaths& paths) {
    std::vector<std::pair<double, int>> offers;
    for (const int a : arcs) {
        const double detour = way_along_features(mesh, layout, paths, a).second;
        if (detour <= longest_detour) offers.emplace_back(detour, a);
    }
    std::ranges::sort(offers);
    for (const auto& [old_detour, a] : offers) {
        auto [path, detour] = way_along_features(mesh, layout, paths, a);
        if (detour > longest_detour) continue;
        const auto [from, to] = layout.arcs()[a];
        paths.draw(from, to, std::move(path.vertices), true);
    }
}

// Places nodes on features.
class FeatureNodes {
  public:
    FeatureNodes(const SurfaceMesh& mesh, const QuadLayout& layout,
                 const std::vector<Vector3>& positions, double most_reach, ArcPaths& paths)
        : mesh_(mesh),
          layout_(layout),
          positions_(positions),
          paths_(paths),
          normals_(node_normals(layout, positions)),
          size_(bounding_box_diagonal(mesh)),
          reach_(layout.n_nodes(), most_reach),
          n_sharp_(layout.n_nodes(), 0),
          valences_(layout.valences()) {
        for (int a = 0; a < layout.n_arcs(); ++a) {
            const auto [from, to] = layout.arcs()[a];
            const double length = (positions[from] - positions[to]).norm();
            const auto& [left, right] = layout.arc_quads(a);
            const double cosine = quad_normal(layout.quads()[left.quad], positions)
                                      .dot(quad_normal(layout.quads()[right.quad], positions));
            for (const int node : {from, to}) {
                reach_[node] = std::min(reach_[node], reach * length);
                n_sharp_[node] += cosine <= std::cos(sharp_angle) ? 1 : 0;
            }
        }
    }

    void place_on_corners(const Features& features) {
        std::vector<Offer> offers;
        for (const VertexHandle corner : features.corners) {
            const int degree = n_feature_edges(mesh_, corner);
            if (degree < 2) continue;
            for (int node = 0; node < layout_.n_nodes(); ++node) {
                const double d = distance(node, corner);
                if (valences_[node] == 0 || d > reach_[node] || !is_same_side(node, corner)) {
                    continue;
                }
                offers.emplace_back(d * (1.0 + 0.5 * std::abs(degree - n_sharp_[node])), node,
                                    corner.idx());
            }
        }
        place_nearest(std::move(offers));
    }

    void place_on_curves() {
        std::vector<Offer> offers;
        for (const auto vertex : mesh_.vertices()) {
            if (n_feature_edges(mesh_, vertex) != 2 || paths_.has_node(vertex)) continue;
            for (int node = 0; node < layout_.n_nodes(); ++node) {
                if (paths_.is_placed(node)) continue;
                const double d = distance(node, vertex);
                // Nodes that lie on a curve stay there.
                if (n_sharp_[node] < 2 && d > same_place * size_) continue;
                if (d > reach_[node] || !is_same_side(node, vertex)) continue;
                offers.emplace_back(d, node, vertex.idx());
            }
        }
        place_nearest(std::move(offers));
    }

  private:
    [[nodiscard]] double distance(int node, VertexHandle vertex) const {
        return (mesh_.point(vertex) - positions_[node]).norm();
    }

    // Whether the surface does not look the other way, as that across a thin wall does.
    [[nodiscard]] bool is_same_side(int node, VertexHandle vertex) const {
        return vertex_normal(mesh_, vertex).dot(normals_[node]) > 0.0;
    }

    // The nearest first, one to one.
    void place_nearest(std::vector<Offer> offers) {
        std::ranges::sort(offers);
        for (const auto& [d, node, vertex] : offers) {
            if (paths_.is_placed(node) || paths_.has_node(VertexHandle(vertex))) continue;
            paths_.place(node, VertexHandle(vertex));
        }
    }

    const SurfaceMesh& mesh_;
    const QuadLayout& layout_;
    const std::vector<Vector3>& positions_;
    ArcPaths& paths_;
    std::vector<Vector3> normals_;
    double size_;
    // How far from a node features may lie that it is placed on.
    std::vector<double> reach_;
    // Sharp arcs of each node.
    std::vector<int> n_sharp_;
    std::vector<int> valences_;
};

}  // namespace

std::vector<LayoutTie> tie_features(SurfaceMesh& mesh, const Features& features,
                                    const QuadLayout& layout, const std::vector<Vector3>& positions,
                                    double most_reach) {
    const double longest_edge = edge_part * bounding_box_diagonal(mesh);
    split_long_edges(mesh, longest_edge);
    ArcPaths paths(mesh, layout);
    FeatureNodes nodes(mesh, layout, positions, std::max(most_reach, longest_edge), paths);
    nodes.place_on_corners(features);
    nodes.place_on_curves();
    std::vector<int> arcs;
    for (int a = 0; a < layout.n_arcs(); ++a) {
        const auto [from, to] = layout.arcs()[a];
        if (paths.is_placed(from) && paths.is_placed(to)) arcs.push_back(a);
    }
    draw_along_features(mesh, layout, arcs, paths);
    return paths.take_ties();
}

}  // namespace couture::meshing
