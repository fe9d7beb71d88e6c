#include "meshing/layout/disc_cuts.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <set>

#include "iga/core/disjoint_sets.h"
#include "iga/core/error.h"
#include "meshing/layout/layout_region.h"

namespace couture::meshing {

namespace {

void draw_straight(const SurfaceMesh& mesh, const QuadLayout& layout,
                   const std::vector<Vector3>& positions, const Vector3& normal, int from, int to,
                   ArcPaths& paths) {
    const Vector3 end = paths.is_placed(to) ? mesh.point(paths.vertex(to)) : positions[to];
    const auto end_cost = [&](VertexHandle v) {
        return (mesh.point(v) - end).norm() * (2.0 - vertex_normal(mesh, v).dot(normal));
    };
    ArcPaths::Path path = paths.find(
        layout.find_arc(from, to), from, paths.vertex(to), [](HalfedgeHandle) { return true; },
        cost_near_line(mesh, mesh.point(paths.vertex(from)), end), end_cost);
    if (path.vertices.size() < 2) {
        throw GeometryError(
            "layout: there is no way for the arc of nodes {} and {} on the surface, between the "
            "arcs beside it; do its nodes lie near the surface?",
            from, to);
    }
    if (!paths.is_placed(to)) paths.place(to, path.vertices.back());
    paths.draw(from, to, std::move(path.vertices), false);
    paths.split_chords();
}

// Nodes of the way between two boundary loops that is the shortest in the layout's own positions.
std::vector<int> shortest_way(const LayoutRegion& region, const std::vector<Vector3>& positions) {
    std::vector<int> best;
    double shortest = std::numeric_limits<double>::infinity();
    for (const LayoutRegion::Path& way : region.paths_between_loops()) {
        std::vector<int> nodes;
        for (const int place : way) nodes.push_back(region.node(place));
        double length = 0.0;
        for (std::size_t k = 0; k + 1 < nodes.size(); ++k) {
            length += (positions[nodes[k]] - positions[nodes[k + 1]]).norm();
        }
        if (length >= shortest) continue;
        shortest = length;
        best = std::move(nodes);
    }
    if (best.empty()) throw TopologyError("layout: no arcs join two boundary loops of a region");
    return best;
}

// Arcs inside a region that are not drawn, the shortest first.
std::vector<int> open_arcs(const LayoutRegion& region, const QuadLayout& layout,
                           const std::vector<Vector3>& positions,
                           const std::vector<bool>& is_drawn) {
    std::set<int> arcs;
    for (const int q : region.quads()) {
        for (const QuadLayout::Side& side : layout.sides(q)) {
            if (!is_drawn[side.arc]) arcs.insert(side.arc);
        }
    }
    const auto length = [&](int a) {
        return (positions[layout.arcs()[a].from] - positions[layout.arcs()[a].to]).norm();
    };
    std::vector<int> sorted(arcs.begin(), arcs.end());
    std::ranges::stable_sort(sorted, {}, length);
    return sorted;
}

// Short arcs that cut a region open to one disc: those that a tree over its quads, through the
// longest arcs, does not cross, without loose ends. Of a sphere two that meet.
std::vector<int> disc_arcs(const LayoutRegion& region, const QuadLayout& layout,
                           const std::vector<Vector3>& positions,
                           const std::vector<bool>& is_drawn) {
    const std::vector<int> open = open_arcs(region, layout, positions, is_drawn);
    std::vector<int> arcs;
    DisjointSets tree(layout.n_quads());
    for (auto a = open.rbegin(); a != open.rend(); ++a) {
        const auto& [left, right] = layout.arc_quads(*a);
        if (tree.find(left.quad) == tree.find(right.quad)) {
            arcs.push_back(*a);
        } else {
            tree.join(left.quad, right.quad);
        }
    }
    std::vector<bool> is_at_drawn(layout.n_nodes(), false);
    for (int a = 0; a < layout.n_arcs(); ++a) {
        if (!is_drawn[a]) continue;
        is_at_drawn[layout.arcs()[a].from] = is_at_drawn[layout.arcs()[a].to] = true;
    }
    for (bool has_loose = true; has_loose;) {
        std::vector<int> n_at(layout.n_nodes(), 0);
        for (const int a : arcs) {
            ++n_at[layout.arcs()[a].from];
            ++n_at[layout.arcs()[a].to];
        }
        const auto is_loose = [&](int node) { return n_at[node] == 1 && !is_at_drawn[node]; };
        const auto n_loose = std::erase_if(arcs, [&](int a) {
            return is_loose(layout.arcs()[a].from) || is_loose(layout.arcs()[a].to);
        });
        has_loose = n_loose > 0;
    }
    if (arcs.empty()) {
        arcs = {open[0]};
        const int node = layout.arcs()[open[0]].to;
        arcs.push_back(*std::find_if(open.begin() + 1, open.end(), [&](int a) {
            return layout.arcs()[a].from == node || layout.arcs()[a].to == node;
        }));
    }
    std::ranges::reverse(arcs);
    return arcs;
}

// The nearest that looks the same way.
VertexHandle nearest_vertex(const SurfaceMesh& mesh, const Vector3& x, const Vector3& normal) {
    VertexHandle nearest;
    double least = std::numeric_limits<double>::infinity();
    for (const auto v : mesh.vertices()) {
        const double cost = (mesh.point(v) - x).norm() * (2.0 - vertex_normal(mesh, v).dot(normal));
        if (cost >= least) continue;
        least = cost;
        nearest = v;
    }
    return nearest;
}

// Draws arcs that hang together, each from a node that has a place.
void draw_connected(const SurfaceMesh& mesh, const QuadLayout& layout,
                    const std::vector<Vector3>& positions, const std::vector<Vector3>& normals,
                    std::vector<int> arcs, ArcPaths& paths) {
    while (!arcs.empty()) {
        auto next = std::ranges::find_if(arcs, [&](int a) {
            return paths.is_placed(layout.arcs()[a].from) || paths.is_placed(layout.arcs()[a].to);
        });
        if (next == arcs.end()) {
            const int node = layout.arcs()[arcs[0]].from;
            paths.place(node, nearest_vertex(mesh, positions[node], normals[node].normalized()));
            next = arcs.begin();
        }
        auto [from, to] = layout.arcs()[*next];
        if (!paths.is_placed(from)) std::swap(from, to);
        draw_straight(mesh, layout, positions, normals[to].normalized(), from, to, paths);
        arcs.erase(next);
    }
}

}  // namespace

void cut_into_discs(const SurfaceMesh& mesh, const QuadLayout& layout,
                    const std::vector<Vector3>& positions, ArcPaths& paths) {
    const std::vector<Vector3> normals = node_normals(layout, positions);
    paths.split_chords();
    std::vector<LayoutRegion> open = layout_regions(layout, paths.is_drawn());
    while (!open.empty()) {
        const LayoutRegion region = std::move(open.back());
        open.pop_back();
        if (region.loops().size() < 2) {
            if (region.loops().size() == 1 && region.euler_characteristic() == 1) continue;
            draw_connected(mesh, layout, positions, normals,
                           disc_arcs(region, layout, positions, paths.is_drawn()), paths);
            continue;
        }
        const std::vector<int> way = shortest_way(region, positions);
        for (std::size_t k = 0; k + 1 < way.size(); ++k) {
            draw_straight(mesh, layout, positions, normals[way[k + 1]].normalized(), way[k],
                          way[k + 1], paths);
        }
        for (LayoutRegion& part : region.parts(paths.is_drawn())) open.push_back(std::move(part));
    }
}

}  // namespace couture::meshing
