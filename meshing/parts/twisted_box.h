#pragma once

#include "meshing/parts/part_definition.h"

namespace couture::meshing {

/// `twisted_box`: one polynomial patch of degrees (2, 2, 3): a bar along z whose sections turn
/// about z and whose axis bows along x. Control points of the section at height z_k are turned by
/// twist z_k / length, so that the section at zeta is scaled by |c(zeta)|, c = sum_k B_k e^(i t_k).
[[nodiscard]] std::vector<PartDefinition> twisted_box_parts();

}  // namespace couture::meshing
