#pragma once

#include <functional>
#include <string>

#include "iga/topology/multipatch.h"
#include "meshing/volume/boundary_features.h"

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

/// Control points, 3 x n_dofs.
[[nodiscard]] MatrixX points_of(const iga::MultiPatch<3>& volume, const iga::DofMap& dofs);

/// The volume with these.
[[nodiscard]] iga::MultiPatch<3> with_points(const iga::MultiPatch<3>& volume,
                                             const iga::DofMap& dofs, const MatrixX& points);

}  // namespace couture::meshing
