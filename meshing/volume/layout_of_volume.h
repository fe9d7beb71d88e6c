#pragma once

#include "iga/topology/multipatch.h"
#include "meshing/layout/volumetric_layout.h"

namespace couture::meshing {

/// A volume's patches as cuboids: cuboid p is patch p, corner and side numbers are the same. Nodes
/// are numbered patch by patch; sets are those of outer sides.
///
/// @throws TopologyError  for a patch whose corners are not eight different ones, as of a collapsed
///                        side; names it
[[nodiscard]] VolumetricLayout layout_of_volume(const iga::MultiPatch<3>& volume);

/// Number of the corner of a cuboid at the low or high end of each direction; free ones count as
/// low.
[[nodiscard]] int corner_at(const std::array<iga::End, 3>& position);

}  // namespace couture::meshing
