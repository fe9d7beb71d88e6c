#include "meshing/topology/pants_curves.h"

#include <algorithm>
#include <set>

#include "iga/core/error.h"

namespace couture::meshing {

namespace {

void check_counts(const std::vector<PantsPatch>& patches, const PantsCurves& all_curves,
                  const std::vector<SurfaceInvariants>& shells) {
    std::vector<PantsCount> found(shells.size());
    std::vector<std::set<int>> curves(shells.size());
    for (const PantsPatch& patch : patches) {
        ++found[patch.shell].n_pants;
        for (const CurveSide& side : patch.boundary) {
            if (all_curves[side.curve].kind == PantsCurveKind::boundary) continue;
            curves[patch.shell].insert(side.curve);
        }
    }
    for (std::size_t s = 0; s < shells.size(); ++s) {
        if (!is_cut_into_pants(shells[s])) continue;
        const PantsCount count = count_pants(shells[s].genus, shells[s].n_boundaries);
        const int n_curves = static_cast<int>(curves[s].size());
        if (found[s].n_pants != count.n_pants || n_curves != count.n_curves) {
            throw TopologyError("pants: shell {}: {} pants and {} curves; there must be {} and {}",
                                s, found[s].n_pants, n_curves, count.n_pants, count.n_curves);
        }
    }
}

}  // namespace

int PantsCurves::add(PantsCurve curve) {
    const int number = size();
    if (curve.kind != PantsCurveKind::boundary) {
        mark_curve(mesh_, curve.curve, number);
        curve.length = curve_length(mesh_, curve.curve);
    }
    curves_.push_back(std::move(curve));
    note_sides(number);
    return number;
}

void PantsCurves::note_sides(int number) {
    for (const HalfedgeHandle h : curve_halfedges(mesh_, curves_[number].curve)) {
        side_of_[h.idx()] = {number, true};
        side_of_[mesh_.opposite_halfedge_handle(h).idx()] = {number, false};
    }
}

void PantsCurves::refine(int number, const std::vector<int>& vertices, const CutSurface& copy,
                         const std::vector<VertexHandle>& handles) {
    SurfaceCurve& curve = curves_[number].curve;
    curve.vertices.clear();
    for (const int v : copy.with_splits(vertices)) curve.vertices.push_back(handles[v]);
    note_sides(number);
}

CurveSide PantsCurves::side_of(const CutSurface& piece, const std::vector<int>& loop) const {
    const int h = loop.front();
    const HalfedgeHandle halfedge = mesh_.find_halfedge(
        VertexHandle(piece.parent(piece.origin(h))), VertexHandle(piece.parent(piece.target(h))));
    return side_of_.at(halfedge.idx());
}

PantsCurves::Sides PantsCurves::sides_of(const CutSurface& piece,
                                         const std::vector<std::vector<int>>& loops) const {
    Sides sides;
    for (std::size_t i = 0; i < loops.size(); ++i) {
        sides.emplace_back(side_of(piece, loops[i]), static_cast<int>(i));
    }
    std::sort(sides.begin(), sides.end());
    return sides;
}

std::vector<std::vector<FaceHandle>> faces_between_curves(const SurfaceMesh& mesh) {
    std::vector<std::vector<FaceHandle>> faces;
    const std::vector<int> region = regions_between_curves(mesh);
    for (const auto face : mesh.faces()) {
        const auto r = static_cast<std::size_t>(region[face.idx()]);
        if (r >= faces.size()) faces.resize(r + 1);
        faces[r].push_back(face);
    }
    return faces;
}

std::vector<PantsPatch> patches_between_curves(const SurfaceMesh& mesh, const PantsCurves& curves,
                                               const std::vector<SurfaceInvariants>& shells,
                                               bool may_be_wide) {
    std::vector<PantsPatch> patches;
    const std::vector<int> shell_of_face = face_components(mesh);
    for (const auto& faces : faces_between_curves(mesh)) {
        const CutSurface piece(mesh, faces, curve_seams(mesh));
        PantsPatch patch;
        patch.shell = shell_of_face[faces.front().idx()];
        for (const auto& [side, loop] : curves.sides_of(piece, piece.boundary_loops())) {
            patch.boundary.push_back(side);
        }
        patch.genus =
            (2 - piece.euler_characteristic() - static_cast<int>(patch.boundary.size())) / 2;
        const bool is_n_pant = may_be_wide && patch.genus == 0;
        if (is_cut_into_pants(shells[patch.shell]) && !is_n_pant &&
            patch.euler_characteristic() != -1) {
            throw TopologyError(
                "pants: patch {} has genus {} and {} boundary loops; it must have genus 0 and 3",
                patches.size(), patch.genus, patch.boundary.size());
        }
        patches.push_back(std::move(patch));
    }
    if (!may_be_wide) check_counts(patches, curves, shells);
    return patches;
}

}  // namespace couture::meshing
