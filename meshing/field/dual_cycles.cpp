#include "meshing/field/dual_cycles.h"

#include <algorithm>
#include <numbers>

#include "iga/core/disjoint_sets.h"
#include "meshing/field/dual_tree.h"
#include "meshing/surface/curvature.h"
#include "meshing/topology/invariants.h"

namespace couture::meshing {

namespace {

DualCycle cycle_around(const SurfaceMesh& mesh, VertexHandle vertex, double gaussian_curvature) {
    DualCycle cycle;
    for (const HalfedgeHandle h : mesh.vih_range(vertex)) cycle.crossed.push_back(h);
    cycle.curvature = 2.0 * std::numbers::pi - gaussian_curvature;
    return cycle;
}

DualCycle cycle_along(const SurfaceMesh& mesh, const BoundaryLoop& loop,
                      const std::vector<double>& geodesic_curvature) {
    DualCycle cycle;
    for (const VertexHandle v : loop.vertices) {
        for (const HalfedgeHandle h : mesh.voh_range(v)) {
            if (!mesh.is_boundary(mesh.edge_handle(h))) cycle.crossed.push_back(h);
        }
        cycle.curvature += geodesic_curvature[v.idx()];
    }
    return cycle;
}

// Halfedges crossed from the root to a face.
std::vector<HalfedgeHandle> path_to(const SurfaceMesh& mesh, const DualTree& tree,
                                    FaceHandle face) {
    std::vector<HalfedgeHandle> path;
    while (tree.crossed[face.idx()].is_valid()) {
        path.push_back(tree.crossed[face.idx()]);
        face = mesh.face_handle(path.back());
    }
    std::reverse(path.begin(), path.end());
    return path;
}

// Over h, back through the tree.
DualCycle cycle_over(const SurfaceMesh& mesh, const DualTree& tree, HalfedgeHandle h) {
    const auto to_left = path_to(mesh, tree, mesh.face_handle(h));
    const auto to_right = path_to(mesh, tree, mesh.face_handle(mesh.opposite_halfedge_handle(h)));
    const auto [left, right] =
        std::mismatch(to_left.begin(), to_left.end(), to_right.begin(), to_right.end());
    DualCycle cycle{{h}, 0.0};
    for (auto back = to_right.end(); back != right;) {
        cycle.crossed.push_back(mesh.opposite_halfedge_handle(*--back));
    }
    cycle.crossed.insert(cycle.crossed.end(), left, to_left.end());
    for (std::size_t k = 0; k < cycle.crossed.size(); ++k) {
        cycle.curvature +=
            turn_between(mesh, cycle.crossed[k], cycle.crossed[(k + 1) % cycle.crossed.size()]);
    }
    return cycle;
}

std::vector<HalfedgeHandle> generating_halfedges(const SurfaceMesh& mesh, const DualTree& tree) {
    std::vector<bool> is_crossed(mesh.n_edges(), false);
    for (const HalfedgeHandle h : tree.crossed) {
        if (h.is_valid()) is_crossed[mesh.edge_handle(h).idx()] = true;
    }
    DisjointSets joined(mesh.n_vertices());
    const auto ends = [&](EdgeHandle edge) {
        const HalfedgeHandle h = mesh.halfedge_handle(edge, 0);
        return std::pair(mesh.from_vertex_handle(h).idx(), mesh.to_vertex_handle(h).idx());
    };
    for (const EdgeHandle edge : mesh.edges()) {
        const auto [v, w] = ends(edge);
        if (mesh.is_boundary(edge)) joined.join(v, w);
    }
    std::vector<HalfedgeHandle> generating;
    for (const EdgeHandle edge : mesh.edges()) {
        if (is_crossed[edge.idx()] || mesh.is_boundary(edge)) continue;
        const auto [v, w] = ends(edge);
        if (joined.find(v) == joined.find(w)) {
            generating.push_back(mesh.halfedge_handle(edge, 0));
        } else {
            joined.join(v, w);
        }
    }
    return generating;
}

}  // namespace

double turn_between(const SurfaceMesh& mesh, HalfedgeHandle before, HalfedgeHandle after) {
    const HalfedgeHandle entry = mesh.opposite_halfedge_handle(before);
    return mesh.next_halfedge_handle(entry) == after ? -corner_angle(mesh, after)
                                                     : corner_angle(mesh, entry);
}

DualCycles make_dual_cycles(const SurfaceMesh& mesh) {
    DualCycles cycles;
    const auto gaussian = gaussian_curvature(mesh);
    for (const VertexHandle v : mesh.vertices()) {
        if (mesh.is_isolated(v) || mesh.is_boundary(v)) continue;
        cycles.inner_vertices.push_back(v);
        cycles.around_vertices.push_back(cycle_around(mesh, v, gaussian[v.idx()]));
    }
    const auto geodesic = geodesic_curvature(mesh);
    for (const BoundaryLoop& loop : boundary_loops(mesh)) {
        cycles.along_boundaries.push_back(cycle_along(mesh, loop, geodesic));
    }
    const DualTree tree = make_dual_tree(mesh);
    for (const HalfedgeHandle h : generating_halfedges(mesh, tree)) {
        cycles.generators.push_back(cycle_over(mesh, tree, h));
    }
    return cycles;
}

}  // namespace couture::meshing
