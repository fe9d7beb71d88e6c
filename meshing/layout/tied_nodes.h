#pragma once

#include <span>
#include <vector>

#include "meshing/layout/embed_layout.h"

namespace couture::meshing {

/// Gives every node along a tie its vertex.
///
/// @param ties  refined where a tie has too few edges for its nodes
/// @return for each node its vertex; invalid for nodes on no tie
/// @throws TopologyError  as embed_layout
[[nodiscard]] std::vector<VertexHandle> place_tied_nodes(SurfaceMesh& mesh,
                                                         const QuadLayout& layout,
                                                         std::vector<LayoutTie>& ties);

}  // namespace couture::meshing
