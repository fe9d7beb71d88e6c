#pragma once

#include <vector>

#include "meshing/layout/arc_paths.h"
#include "meshing/surface/features.h"

namespace couture::meshing {

/// Ties of a layout to the features of the surface that it lies near.
///
/// Feature corners take the nearest nodes, one to one, within seven tenths of the node's shortest
/// arc; then nodes with two or more sharp arcs that are as near to a feature curve lie on it, and
/// arcs between nodes on features follow these where the way is at most 1.8 times as long as the
/// straight line. Nodes that lie on a curve stay on it.
///
/// @param mesh        with numbers of features on its edges; long edges are split
/// @param layout      the boundary of a volumetric one
/// @param most_reach  no node moves farther, but for the length of an edge
/// @return one for each arc on features; none if no feature runs along an arc
[[nodiscard]] std::vector<LayoutTie> tie_features(SurfaceMesh& mesh, const Features& features,
                                                  const QuadLayout& layout,
                                                  const std::vector<Vector3>& positions,
                                                  double most_reach);

}  // namespace couture::meshing
