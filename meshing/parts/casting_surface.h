#pragma once

#include <vector>

#include "meshing/parts/part_surface_definition.h"

namespace couture::meshing {

/// `casting`: a round flange with four bolt holes and a hub, bored through.
[[nodiscard]] std::vector<PartSurfaceDefinition> casting_surfaces();

}  // namespace couture::meshing
