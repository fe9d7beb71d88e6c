#pragma once

#include <string>
#include <vector>

#include "meshing/layout/volumetric_layout.h"
#include "meshing/surface/features.h"

namespace couture::meshing {

/// The layout with the nodes of its boundary moved onto the surface: each to the nearest feature
/// corner within the tolerance, else to the nearest place of a feature curve within it, else to the
/// nearest of the surface. Nodes inside stay.
///
/// @param mesh       with numbers of features on its edges; gets vertices where nodes come to
///                   feature curves
/// @param names      of the nodes, for messages
/// @param tolerance  how far a node may move; positive
/// @throws InputError  if the tolerance is not positive, or a node is farther from the surface, or
///                     two nodes come to one place: names them, where they are and what to do
///
/// Source: [Maquart19] Sec. 3.2.2, nodes given by hand.
[[nodiscard]] PlacedLayout snap_nodes(SurfaceMesh& mesh, const Features& features,
                                      PlacedLayout placed, const std::vector<std::string>& names,
                                      double tolerance);

}  // namespace couture::meshing
