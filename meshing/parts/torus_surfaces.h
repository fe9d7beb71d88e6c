#pragma once

#include <vector>

#include "meshing/parts/part_surface_definition.h"

namespace couture::meshing {

/// `torus`, and `double_torus`: two of them side by side that run into each other at x = 0.
///
/// Their axes are the tube's radius and a half of it further apart than twice the radius: so they
/// meet in one oval, at 60 to 123 degrees between their normals.
[[nodiscard]] std::vector<PartSurfaceDefinition> torus_surfaces();

}  // namespace couture::meshing
