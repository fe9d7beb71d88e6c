#pragma once

#include <vector>

#include "meshing/surface/cut_surface.h"
#include "meshing/surface/surface_mesh.h"

namespace couture::meshing {

/// A simple edge path on a mesh.
struct SurfaceCurve {
    /// In order; of a closed curve the first one does not stand again at the end.
    std::vector<VertexHandle> vertices;
    bool is_closed = true;
};

[[nodiscard]] double curve_length(const SurfaceMesh& mesh, const SurfaceCurve& curve);

/// Halfedges along a curve, in its direction.
///
/// @throws TopologyError  if two vertices in a row have no common edge; names them
[[nodiscard]] std::vector<HalfedgeHandle> curve_halfedges(const SurfaceMesh& mesh,
                                                          const SurfaceCurve& curve);

/// Writes a curve's number on its edges.
///
/// @throws TopologyError  if an edge belongs to another curve, or a vertex stands twice on the
/// curve
///                        or lies on another one: curves must be simple and must not cross
void mark_curve(SurfaceMesh& mesh, const SurfaceCurve& curve, int number);

/// Repeats on a mesh the splits that were made on a piece of it.
///
/// @return the vertex of the mesh for each vertex of the piece
std::vector<VertexHandle> embed_splits(SurfaceMesh& mesh, const CutSurface& piece);

/// Splits every edge that joins two vertices of curves or boundaries and lies on none itself, so
/// that between curves there is a way (see CutSurface::split_chords).
void split_chords_between_curves(SurfaceMesh& mesh);

/// For each edge whether it belongs to a curve: the seams along which pieces are cut.
[[nodiscard]] std::vector<bool> curve_seams(const SurfaceMesh& mesh);

/// Numbers the regions between curves, counted in the order of their smallest face.
///
/// @return for each face the number of its region
[[nodiscard]] std::vector<int> regions_between_curves(const SurfaceMesh& mesh);

}  // namespace couture::meshing
