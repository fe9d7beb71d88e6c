#pragma once

#include <functional>
#include <string>

#include "iga/topology/multipatch.h"
#include "meshing/volume/boundary_features.h"
#include "meshing/volume/volume_points.h"

namespace couture::meshing {

/// The unit cube, `n` elements of the degree in each direction.
[[nodiscard]] iga::MultiPatch<3> cube_of(int degree, int n);

/// Like `cube_of`, cut into two patches at x = 1/2.
[[nodiscard]] iga::MultiPatch<3> two_patch_cube(int degree, int n);

/// A part with `n` elements per direction. Degree 1: through the points at the breakpoints.
[[nodiscard]] iga::MultiPatch<3> part_of(const std::string& name, int degree, int n);

/// Control points moved by `map`.
[[nodiscard]] iga::MultiPatch<3> moved(const iga::MultiPatch<3>& volume,
                                       const std::function<Vector3(const Vector3&)>& map);

}  // namespace couture::meshing
