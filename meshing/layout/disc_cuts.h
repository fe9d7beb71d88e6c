#pragma once

#include <vector>

#include "meshing/layout/arc_paths.h"

namespace couture::meshing {

/// Draws arcs until the drawn ones cut the surface into discs: where a region has several boundary
/// loops, the shortest ways of fewest arcs between two of them; where it has none, or handles,
/// short arcs that cut it open to one disc. They are shortest paths near to their straight lines;
/// nodes on them lie where the surface is nearest.
///
/// @throws TopologyError  if no arcs join two boundary loops of a region
/// @throws GeometryError  if an arc can't be drawn: names its nodes
void cut_into_discs(const SurfaceMesh& mesh, const QuadLayout& layout,
                    const std::vector<Vector3>& positions, ArcPaths& paths);

}  // namespace couture::meshing
