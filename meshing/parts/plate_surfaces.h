#pragma once

#include <vector>

#include "meshing/parts/part_surface_definition.h"

namespace couture::meshing {

/// `plate` with one round hole and `plate_with_two_holes`.
[[nodiscard]] std::vector<PartSurfaceDefinition> plate_surfaces();

}  // namespace couture::meshing
