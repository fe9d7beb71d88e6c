#include "meshing/layout/disc_cuts.h"

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

}  // namespace

void cut_into_discs(const SurfaceMesh& mesh, const QuadLayout& layout,
                    const std::vector<Vector3>& positions, ArcPaths& paths) {
    const std::vector<Vector3> normals = node_normals(layout, positions);
    paths.split_chords();
    std::vector<LayoutRegion> open = layout_regions(layout, paths.is_drawn());
    while (!open.empty()) {
        const LayoutRegion region = std::move(open.back());
        open.pop_back();
        if (region.loops().size() < 2) continue;
        const std::vector<int> way = shortest_way(region, positions);
        for (std::size_t k = 0; k + 1 < way.size(); ++k) {
            draw_straight(mesh, layout, positions, normals[way[k + 1]].normalized(), way[k],
                          way[k + 1], paths);
        }
        for (LayoutRegion& part : region.parts(paths.is_drawn())) open.push_back(std::move(part));
    }
}

}  // namespace couture::meshing
