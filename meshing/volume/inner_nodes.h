#pragma once

#include <vector>

#include "meshing/volume/layout_cells.h"
#include "meshing/volume/parameterize_volume.h"

namespace couture::meshing {

/// Positions for the nodes inside a layout from those on its boundary: once by the graph Laplacian,
/// once behind the boundary along its normals where an edge leads there (rings pull the first
/// towards their middle) with the Laplacian for the rest; both are unfolded and improved as
/// straight cuboids (see parameterize_volume), and the one with the larger smallest scaled Jacobian
/// is taken. If both stay folded, the second is taken as it started: cuboids that are bent by more
/// than half a turn can't be straight.
///
/// @param nodes  n_nodes x 3
/// @param is_given  for each node whether it lies on the boundary and stays
[[nodiscard]] MatrixX place_inner_nodes(const VolumetricLayout& layout, const LayoutCells& cells,
                                        const MatrixX& nodes, const std::vector<bool>& is_given,
                                        const ParameterizationOptions& options);

}  // namespace couture::meshing
