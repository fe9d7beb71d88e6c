#pragma once

#include "meshing/parts/part_definition.h"

namespace couture::meshing {

/// `pipe_tee`: two thick pipes of equal diameter that meet at a right angle.
///
/// The run lies along x, the branch along +z. The run is split at y = 0 and z = 0, the branch at
/// x = 0 and y = 0; they meet on the mitre planes x = +-z (z >= 0), the run's lower halves on x =
/// 0. 12 quarter pipes (radius, arc, axis), 18 interfaces, 36 outer sides; on each of the two lines
/// where y axis and wall meet, six patches share an edge.
[[nodiscard]] std::vector<PartDefinition> pipe_tee_parts();

}  // namespace couture::meshing
