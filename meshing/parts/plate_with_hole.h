#pragma once

#include "meshing/parts/part_definition.h"

namespace couture::meshing {

/// `plate_with_hole` and `plate_with_hole_3d`: the first quadrant of a square plate with a circular
/// hole, two patches (radius, angle[, thickness]) that meet on the diagonal; no collapsed corners.
[[nodiscard]] std::vector<PartDefinition> plate_with_hole_parts();

}  // namespace couture::meshing
