#pragma once

#include "meshing/parts/part_definition.h"

namespace couture::meshing {

/// `cylinder_o_grid`: solid cylinder about z without a collapsed edge: a square core and four outer
/// patches, exact NURBS.
[[nodiscard]] std::vector<PartDefinition> o_grid_parts();

}  // namespace couture::meshing
