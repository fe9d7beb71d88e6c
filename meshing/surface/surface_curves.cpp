#include "meshing/surface/surface_curves.h"

#include <algorithm>
#include <set>

#include "iga/core/error.h"

namespace couture::meshing {

double curve_length(const SurfaceMesh& mesh, const SurfaceCurve& curve) {
    double length = 0.0;
    for (const HalfedgeHandle h : curve_halfedges(mesh, curve)) {
        length += edge_length(mesh, mesh.edge_handle(h));
    }
    return length;
}

std::vector<HalfedgeHandle> curve_halfedges(const SurfaceMesh& mesh, const SurfaceCurve& curve) {
    std::vector<HalfedgeHandle> halfedges;
    const std::size_t n = curve.vertices.size();
    for (std::size_t k = 0; k + (curve.is_closed ? 0 : 1) < n; ++k) {
        const VertexHandle from = curve.vertices[k];
        const VertexHandle to = curve.vertices[(k + 1) % n];
        halfedges.push_back(mesh.find_halfedge(from, to));
        if (!halfedges.back().is_valid()) {
            throw TopologyError(
                "curve: vertices {} and {} follow each other but have no common edge; a curve must "
                "be a path of edges",
                from.idx(), to.idx());
        }
    }
    return halfedges;
}

void mark_curve(SurfaceMesh& mesh, const SurfaceCurve& curve, int number) {
    std::set<int> seen;
    for (const VertexHandle vertex : curve.vertices) {
        if (!seen.insert(vertex.idx()).second) {
            throw TopologyError("curve {}: it passes vertex {} twice; curves must be simple",
                                number, vertex.idx());
        }
        for (const auto edge : mesh.ve_range(vertex)) {
            if (mesh.data(edge).curve >= 0 && mesh.data(edge).curve != number) {
                throw TopologyError(
                    "curve {}: it meets curve {} at vertex {}; curves must not touch", number,
                    mesh.data(edge).curve, vertex.idx());
            }
        }
    }
    for (const HalfedgeHandle h : curve_halfedges(mesh, curve)) {
        mesh.data(mesh.edge_handle(h)).curve = number;
    }
}

std::vector<VertexHandle> embed_splits(SurfaceMesh& mesh, const CutSurface& piece) {
    std::vector<VertexHandle> vertices(piece.n_vertices());
    for (int v = 0; v < piece.n_vertices(); ++v) {
        if (piece.parent(v) >= 0) vertices[v] = VertexHandle(piece.parent(v));
    }
    for (const auto& split : piece.splits()) {
        const VertexHandle from = vertices[piece.original(split.from)];
        const VertexHandle to = vertices[piece.original(split.to)];
        const HalfedgeHandle h = mesh.find_halfedge(from, to);
        if (!h.is_valid()) {
            throw TopologyError(
                "embedding: vertices {} and {} have no common edge any more; the mesh was changed "
                "since the piece was taken from it",
                from.idx(), to.idx());
        }
        vertices[split.vertex] = split_edge(mesh, h, split.fraction);
    }
    for (int v = 0; v < piece.n_vertices(); ++v) vertices[v] = vertices[piece.original(v)];
    return vertices;
}

void split_chords_between_curves(SurfaceMesh& mesh) {
    std::vector<char> is_blocked(mesh.n_vertices(), 0);
    for (const auto edge : mesh.edges()) {
        if (mesh.data(edge).curve < 0 && !mesh.is_boundary(edge)) continue;
        const HalfedgeHandle h = mesh.halfedge_handle(edge, 0);
        is_blocked[mesh.from_vertex_handle(h).idx()] = 1;
        is_blocked[mesh.to_vertex_handle(h).idx()] = 1;
    }
    // Edges that come by splits end inside.
    const auto n_edges = static_cast<int>(mesh.n_edges());
    for (int e = 0; e < n_edges; ++e) {
        const EdgeHandle edge(e);
        if (mesh.data(edge).curve >= 0 || mesh.is_boundary(edge)) continue;
        const HalfedgeHandle h = mesh.halfedge_handle(edge, 0);
        const int from = mesh.from_vertex_handle(h).idx();
        const int to = mesh.to_vertex_handle(h).idx();
        const auto is_on_curve = [&](int v) {
            return v < static_cast<int>(is_blocked.size()) && is_blocked[v];
        };
        if (is_on_curve(from) && is_on_curve(to)) split_edge(mesh, h);
    }
}

std::vector<bool> curve_seams(const SurfaceMesh& mesh) {
    std::vector<bool> is_seam(mesh.n_edges());
    for (const auto edge : mesh.edges()) is_seam[edge.idx()] = mesh.data(edge).curve >= 0;
    return is_seam;
}

std::vector<int> regions_between_curves(const SurfaceMesh& mesh) {
    std::vector<int> region(mesh.n_faces(), -1);
    int n_regions = 0;
    std::vector<FaceHandle> stack;
    for (const auto start : mesh.faces()) {
        if (region[start.idx()] >= 0) continue;
        region[start.idx()] = n_regions;
        stack.push_back(start);
        while (!stack.empty()) {
            const FaceHandle face = stack.back();
            stack.pop_back();
            for (const auto h : mesh.fh_range(face)) {
                if (mesh.data(mesh.edge_handle(h)).curve >= 0) continue;
                const FaceHandle neighbour = mesh.face_handle(mesh.opposite_halfedge_handle(h));
                if (!neighbour.is_valid() || region[neighbour.idx()] >= 0) continue;
                region[neighbour.idx()] = n_regions;
                stack.push_back(neighbour);
            }
        }
        ++n_regions;
    }
    return region;
}

}  // namespace couture::meshing
