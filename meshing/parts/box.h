#pragma once

#include "meshing/parts/part_definition.h"

namespace couture::meshing {

/// `rectangle`, `box`, `cantilever`: axis-parallel boxes of one patch of degree 1.
[[nodiscard]] std::vector<PartDefinition> box_parts();

}  // namespace couture::meshing
