#pragma once

#include "meshing/parts/part_definition.h"

namespace couture::meshing {

/// `scordelis_lo` and `pinched_cylinder`: sectors of thick cylindrical shells of one patch (radius,
/// angle, axis). The axis is y, the angle runs from +z towards +x: a point is
/// (r sin t, y, r cos t); y = 0 is the end with the diaphragm, y = length / 2 is mid-span.
[[nodiscard]] std::vector<PartDefinition> cylindrical_shell_parts();

}  // namespace couture::meshing
