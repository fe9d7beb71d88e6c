#pragma once

#include "meshing/parts/part_definition.h"

namespace couture::meshing {

/// `le1_membrane` and `le10_plate`: the quarter elliptic rings of the NAFEMS benchmarks, with their
/// point names: A = (0, inner_y), B = (0, outer_y), C = (outer_x, 0), D = (inner_x, 0). The plate
/// is split at mid-thickness, so that the line of its support is an edge of patches. Source:
/// [NAFEMS90].
[[nodiscard]] std::vector<PartDefinition> nafems_parts();

}  // namespace couture::meshing
