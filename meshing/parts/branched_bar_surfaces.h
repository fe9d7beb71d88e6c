#pragma once

#include <vector>

#include "meshing/parts/part_surface_definition.h"

namespace couture::meshing {

/// `pant`, `double_t` and `double_curved_t`: a bar along x with one or two branches to +y, of
/// square section.
///
/// A leg starts at the straight body and ends at a cap with the normal it would have without its
/// offsets. Sections parallel to the cap keep size and direction; at the part t of the leg's length
/// they are moved by 3 t^2 - 2 t^3 times the offset of the cap: a cubic, so a spline volume of
/// degree 3 has just this shape, and one whose volume does not depend on the offset.
[[nodiscard]] std::vector<PartSurfaceDefinition> branched_bar_surfaces();

}  // namespace couture::meshing
