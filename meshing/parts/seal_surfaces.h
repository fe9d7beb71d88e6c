#pragma once

#include <vector>

#include "meshing/parts/part_surface_definition.h"

namespace couture::meshing {

/// `seal`: a ring about z with arms along +-x, and `half_seal`, what lies at x >= 0.
///
/// `half_seal` has the parameters and, as far as they are outer sides, the names of the spline part
/// (arm_half_width R1, inner_radius R2, outer_radius R3, ring_height H1, arm_height H2, arm_length
/// L1 of the seal).
[[nodiscard]] std::vector<PartSurfaceDefinition> seal_surfaces();

}  // namespace couture::meshing
