#include "meshing/topology/handle_cuts.h"

#include "meshing/topology/handle_tunnel_loops.h"
#include "meshing/topology/invariants.h"

namespace couture::meshing {

namespace {

// Given loops that lie on a surface, by its vertices.
struct GivenCuts {
    std::vector<std::vector<int>> cuts;
    std::vector<int> curve_of_cut;
};

CutSurface surface_of_shell(const SurfaceMesh& mesh, int shell) {
    std::vector<FaceHandle> faces;
    const std::vector<int> component = face_components(mesh);
    for (const auto face : mesh.faces()) {
        if (component[face.idx()] == shell) faces.push_back(face);
    }
    return CutSurface(mesh, faces, std::vector<bool>(mesh.n_edges(), false));
}

GivenCuts given_cuts(const SurfaceMesh& mesh, const CutSurface& whole, const PantsCurves& curves,
                     int first_given) {
    std::vector<int> number(mesh.n_vertices(), -1);
    for (int v = 0; v < whole.n_vertices(); ++v) number[whole.parent(v)] = v;
    GivenCuts given;
    for (int c = first_given; c < curves.size(); ++c) {
        const auto& vertices = curves[c].curve.vertices;
        if (number[vertices.front().idx()] < 0) continue;
        given.curve_of_cut.push_back(c);
        auto& cut = given.cuts.emplace_back();
        for (const VertexHandle v : vertices) cut.push_back(number[v.idx()]);
    }
    return given;
}

// Handles are shortest by plain length; each is pulled tight between all others.
void tighten_handles(SurfaceMesh& mesh, int first_number, const HandleCutOptions& options,
                     std::vector<SurfaceCurve>& handles) {
    const auto mark = [&](const SurfaceCurve& curve, int number) {
        for (const HalfedgeHandle h : curve_halfedges(mesh, curve)) {
            mesh.data(mesh.edge_handle(h)).curve = number;
        }
    };
    for (const SurfaceCurve& curve : handles) mark(curve, first_number);
    for (SurfaceCurve& curve : handles) {
        mark(curve, -1);
        curve = options.tightened(curve);
        mark(curve, first_number);
    }
    for (const SurfaceCurve& curve : handles) mark(curve, -1);
}

}  // namespace

std::vector<std::vector<Vector3>> cut_handles(SurfaceMesh& mesh, int shell, PantsCurves& curves,
                                              const HandleCutOptions& options) {
    const CutSurface whole = surface_of_shell(mesh, shell);
    const auto [cuts, curve_of_cut] = given_cuts(mesh, whole, curves, options.first_given);
    const HandleTunnelLoops loops = find_handle_tunnel_loops(whole, cuts, options.only_given);
    const auto vertices = embed_splits(mesh, loops.surface);
    for (std::size_t c = 0; c < cuts.size(); ++c) {
        if (loops.is_handle_cut[c]) curves.set_kind(curve_of_cut[c], PantsCurveKind::handle);
        curves.refine(curve_of_cut[c], cuts[c], loops.surface, vertices);
    }
    std::vector<std::vector<Vector3>> tunnels;
    for (const HomologyLoop& loop : loops.tunnels) {
        auto& points = tunnels.emplace_back();
        for (const int v : loop.vertices) points.push_back(loops.surface.point(v));
    }
    if (!options.cuts) return tunnels;
    std::vector<SurfaceCurve> handles;
    for (const HomologyLoop& loop : loops.handles) {
        SurfaceCurve& curve = handles.emplace_back();
        for (const int v : loop.vertices) curve.vertices.push_back(vertices[v]);
    }
    if (options.tightened) tighten_handles(mesh, curves.size(), options, handles);
    for (SurfaceCurve& curve : handles) {
        curves.add({.kind = PantsCurveKind::handle, .curve = std::move(curve)});
    }
    split_chords_between_curves(mesh);
    return tunnels;
}

}  // namespace couture::meshing
