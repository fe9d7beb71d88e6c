#pragma once

#include "meshing/parts/part_definition.h"

namespace couture::meshing {

/// `cook` and `cook_3d`: Cook's tapered membrane (0, 0), (48, 44), (48, 60), (0, 44), one patch of
/// degree 1. Source: [Cook74].
[[nodiscard]] std::vector<PartDefinition> cook_parts();

}  // namespace couture::meshing
