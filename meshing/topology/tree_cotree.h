#pragma once

#include <span>
#include <vector>

#include "meshing/surface/cut_surface.h"
#include "meshing/surface/shortest_paths.h"

namespace couture::meshing {

/// A forest of shortest paths over the vertices of a surface, a spanning tree of its triangles that
/// crosses none of it, and the edges in neither.
struct TreeCotree {
    /// Bound to the surface that was given.
    ShortestPaths tree;
    /// For each triangle the halfedges over which the cotree leaves it.
    std::vector<std::vector<int>> cotree;
    /// Halfedges of the edges left over, those with the longest loops (path to the one end, edge,
    /// path from the other) first.
    std::vector<int> generators;
};

/// The cotree is a maximum spanning tree with respect to the lengths of loops, so that those of the
/// generators are short. O(n log n).
///
/// @param surface  connected, closed or with one boundary
/// @param sources  one vertex if closed, all of the boundary if not: then there are twice as many
///                 generators as the genus
///
/// Source: [EricksonWhittlesey05] Sec. 3.
[[nodiscard]] TreeCotree make_tree_cotree(const CutSurface& surface, std::span<const int> sources);

}  // namespace couture::meshing
