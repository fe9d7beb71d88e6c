#pragma once

#include <vector>

#include "meshing/parts/part_surface_definition.h"

namespace couture::meshing {

/// `cube`, `cylinder` and `sierpinski`, the sponge of level 1: a cube with a square hole through
/// the middle third along each axis, genus 5.
[[nodiscard]] std::vector<PartSurfaceDefinition> block_surfaces();

}  // namespace couture::meshing
