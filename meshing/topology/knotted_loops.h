#pragma once

#include <cstddef>
#include <vector>

#include "meshing/topology/homology_basis.h"
#include "meshing/topology/loop_kind.h"

namespace couture::meshing {

/// Simple loops of a kind that are not made of two shortest paths and an edge, as those of knotted
/// tubes: the shortest closed walks through the sources, by Dijkstra's algorithm in a covering of
/// the surface, on pairs of a vertex and the class so far.
///
/// @param projector  see linking_projector
/// @param sources    vertices that such loops are likely to pass
/// @param chosen     classes, as rows, that the loops extend to a primitive system
/// @return at most n; fewer if coefficients beyond 8 (1 + the largest of A) are needed, or if a
///         search takes more than 2e7 such pairs
[[nodiscard]] std::vector<AnnotatedLoop> find_knotted_loops(
    const AnnotatedSurface& annotated, const IntegerMatrix& projector, LoopKind kind,
    const std::vector<int>& sources, const IntegerMatrix& chosen, std::size_t n);

}  // namespace couture::meshing
