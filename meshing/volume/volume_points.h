#pragma once

#include "iga/topology/dof_map.h"
#include "iga/topology/multipatch.h"

namespace couture::meshing {

/// Control points of a body, shared ones once: those of the first patch. 3 x n_dofs.
[[nodiscard]] MatrixX points_of(const iga::MultiPatch<3>& volume, const iga::DofMap& dofs);

/// The body with these, 3 x n_dofs.
[[nodiscard]] iga::MultiPatch<3> with_points(const iga::MultiPatch<3>& volume,
                                             const iga::DofMap& dofs, const MatrixX& points);

}  // namespace couture::meshing
