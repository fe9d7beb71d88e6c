#pragma once

#include "meshing/parts/part_definition.h"

namespace couture::meshing {

/// `quarter_annulus`, `thick_cylinder` (and `_3d`): the ring in the first quadrant, one NURBS patch
/// (radius, angle[, height]); `half_annulus`: the half ring x >= 0 of two patches, the meridian of
/// a hollow sphere with x the radius and y the axis.
[[nodiscard]] std::vector<PartDefinition> annulus_parts();

}  // namespace couture::meshing
