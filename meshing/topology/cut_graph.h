#pragma once

#include <vector>

#include "meshing/surface/cut_surface.h"

namespace couture::meshing {

/// Edges along which a connected surface of any genus, with or without boundary, opens to a disc.
///
/// Boundaries are joined by shortest paths, the nearest first; then the genus is cut along the
/// generators of a tree of shortest paths (from the boundary, else from the first vertex) and its
/// cotree, without the branches that lead nowhere. A sphere is opened along the shortest path from
/// its first vertex to the one farthest away. O((1 + boundaries) n log n).
///
/// @return one halfedge for each edge, ascending; none for a disc
/// @throws TopologyError  if the surface is not connected or has no triangles
///
/// Source: [EricksonWhittlesey05]; [Maquart19] Sec. 2.1.2, 4.2.1.
[[nodiscard]] std::vector<int> cut_graph(const CutSurface& surface);

/// The surface, opened along its cut graph: a disc, which is checked.
///
/// @throws as cut_graph
[[nodiscard]] CutSurface open_to_disc(const CutSurface& surface);

/// 2 genus loops through one vertex that generate the fundamental group of a closed surface: among
/// all such systems the one of least length. Cut along all of them the surface is a disc.
///
/// @param base  vertex where each loop starts and ends
/// @return for each loop its halfedges, shortest loop first: a shortest path from the base, an
/// edge,
///         and a shortest path back; loops may share edges near the base
/// @throws TopologyError  if the surface is not connected or has a boundary
/// @throws InputError     if there is no such vertex
///
/// Source: [EricksonWhittlesey05] Sec. 3.4; [Maquart19] Prop. 2.1.
[[nodiscard]] std::vector<std::vector<int>> system_of_loops(const CutSurface& surface, int base);

}  // namespace couture::meshing
