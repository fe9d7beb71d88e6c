#pragma once

#include <vector>

#include "meshing/parts/part_surface_definition.h"

namespace couture::meshing {

/// `wheel`: boss and hub, a web with two windows along +-x, and a rim.
[[nodiscard]] std::vector<PartSurfaceDefinition> wheel_surfaces();

}  // namespace couture::meshing
