#include "meshing/topology/n_pants.h"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <numbers>
#include <optional>

#include "iga/core/disjoint_sets.h"
#include "iga/core/error.h"
#include "meshing/surface/shortest_paths.h"

namespace couture::meshing {

namespace {

// Patches on both sides of each curve: left, right; -1 outside.
std::vector<std::array<int, 2>> patches_beside(const PantsDecomposition& pants) {
    std::vector<std::array<int, 2>> beside(pants.curves.size(), {-1, -1});
    for (std::size_t p = 0; p < pants.patches.size(); ++p) {
        for (const CurveSide& side : pants.patches[p].boundary) {
            beside[side.curve][side.is_left ? 0 : 1] = static_cast<int>(p);
        }
    }
    return beside;
}

// How far from a curve on one of its sides the other boundary loops of the patch are still joined
// by points that are as far away: the level at which circles around the tube break up.
double depth(const SurfaceMesh& mesh, const PantsDecomposition& pants, const CurveSide& from,
             int patch) {
    std::vector<FaceHandle> faces;
    for (const auto face : mesh.faces()) {
        if (pants.patch_of_face[face.idx()] == patch) faces.push_back(face);
    }
    const CutSurface piece(mesh, faces, curve_seams(mesh));
    const auto halfedges = curve_halfedges(mesh, pants.curves[from.curve].curve);
    HalfedgeHandle first = halfedges.front();
    if (!from.is_left) first = mesh.opposite_halfedge_handle(first);
    const int start = mesh.from_vertex_handle(first).idx();
    const int end = mesh.to_vertex_handle(first).idx();

    std::vector<int> sources;
    std::vector<std::vector<int>> others;
    for (const auto& loop : piece.boundary_loops()) {
        const bool is_source = std::any_of(loop.begin(), loop.end(), [&](int h) {
            return piece.parent(piece.origin(h)) == start && piece.parent(piece.target(h)) == end;
        });
        std::vector<int> vertices;
        for (const int h : loop) vertices.push_back(piece.origin(h));
        if (is_source && sources.empty()) {
            sources = std::move(vertices);
        } else {
            others.push_back(std::move(vertices));
        }
    }
    ShortestPaths search(piece);
    search.run({.sources = sources, .takes_boundary_edges = true});
    DisjointSets joined(static_cast<std::size_t>(piece.n_vertices()));
    double nearest = std::numeric_limits<double>::infinity();
    for (const auto& loop : others) {
        for (const int v : loop) {
            joined.join(v, loop.front());
            nearest = std::min(nearest, search.distance(v));
        }
    }
    // From the farthest vertices on.
    std::vector<char> is_in(piece.n_vertices(), 0);
    const auto& settled = search.settled();
    for (auto v = settled.rbegin(); v != settled.rend(); ++v) {
        is_in[*v] = 1;
        const int begin = piece.outgoing(*v);
        for (int h = begin; h >= 0;) {
            for (const int w : {piece.target(h), piece.origin(CutSurface::previous(h))}) {
                if (is_in[w] != 0) joined.join(*v, w);
            }
            h = piece.rotated(h);
            if (h == begin) break;
        }
        const auto root = joined.find(others.front().front());
        if (std::all_of(others.begin(), others.end(), [&](const std::vector<int>& loop) {
                return joined.find(loop.front()) == root;
            })) {
            return std::min(nearest, search.distance(*v));
        }
    }
    return 0.0;
}

void remove_curve(SurfaceMesh& mesh, PantsDecomposition& pants, int curve) {
    const auto beside = patches_beside(pants)[curve];
    const auto [kept, gone] = std::minmax(beside[0], beside[1]);
    for (const HalfedgeHandle h : curve_halfedges(mesh, pants.curves[curve].curve)) {
        mesh.data(mesh.edge_handle(h)).curve = -1;
    }
    for (const auto edge : mesh.edges()) {
        int& number = mesh.data(edge).curve;
        if (number > curve) --number;
    }
    auto& boundary = pants.patches[kept].boundary;
    const auto& added = pants.patches[gone].boundary;
    boundary.insert(boundary.end(), added.begin(), added.end());
    pants.patches.erase(pants.patches.begin() + gone);
    pants.curves.erase(pants.curves.begin() + curve);
    for (PantsPatch& patch : pants.patches) {
        std::erase_if(patch.boundary, [&](const CurveSide& side) { return side.curve == curve; });
        for (CurveSide& side : patch.boundary) side.curve -= side.curve > curve ? 1 : 0;
        std::sort(patch.boundary.begin(), patch.boundary.end());
    }
    // Cycles around a curve that is gone run around more than two.
    for (PantsCurve& other : pants.curves) {
        if (!other.around) continue;
        if ((*other.around)[0].curve == curve || (*other.around)[1].curve == curve) {
            other.around.reset();
            continue;
        }
        for (CurveSide& side : *other.around) side.curve -= side.curve > curve ? 1 : 0;
    }
    for (int& patch : pants.patch_of_face) {
        if (patch == gone) patch = kept;
        if (patch > gone) --patch;
    }
}

}  // namespace

Tube measure_tube(const SurfaceMesh& mesh, const PantsDecomposition& pants, int curve) {
    if (curve < 0 || curve >= static_cast<int>(pants.curves.size()) ||
        pants.curves[curve].kind == PantsCurveKind::boundary) {
        throw InputError("tube: curve {} is no cut of the {} curves", curve, pants.curves.size());
    }
    const auto beside = patches_beside(pants)[curve];
    return {.length = depth(mesh, pants, {curve, true}, beside[0]) +
                      depth(mesh, pants, {curve, false}, beside[1]),
            .diameter = pants.curves[curve].length / std::numbers::pi};
}

void merge_pants(SurfaceMesh& mesh, PantsDecomposition& pants, int most_boundaries, double ratio) {
    std::vector<std::optional<Tube>> tubes(pants.curves.size());
    for (;;) {
        const auto beside = patches_beside(pants);
        std::optional<int> best;
        double least = ratio;
        for (int c = 0; c < static_cast<int>(pants.curves.size()); ++c) {
            const auto [left, right] = beside[c];
            if (left < 0 || right < 0 || left == right) continue;
            const auto n_boundaries =
                pants.patches[left].boundary.size() + pants.patches[right].boundary.size() - 2;
            if (static_cast<int>(n_boundaries) > most_boundaries) continue;
            if (!tubes[c]) tubes[c] = measure_tube(mesh, pants, c);
            const double relative = tubes[c]->length / tubes[c]->diameter;
            // Rounding decides nothing.
            if (relative >= (best ? 1.0 - 1e-9 : 1.0) * least) continue;
            best = c;
            least = relative;
        }
        if (!best) return;
        // Tubes that end in the new patch are others now.
        for (std::size_t c = 0; c < tubes.size(); ++c) {
            for (const int patch : beside[c]) {
                if (patch == beside[*best][0] || patch == beside[*best][1]) tubes[c].reset();
            }
        }
        tubes.erase(tubes.begin() + *best);
        remove_curve(mesh, pants, *best);
    }
}

}  // namespace couture::meshing
