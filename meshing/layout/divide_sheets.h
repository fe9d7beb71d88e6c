#pragma once

#include <array>
#include <map>
#include <vector>

#include "meshing/layout/volumetric_layout.h"

namespace couture::meshing {

/// Places of new nodes on edges of a layout, by the edges' nodes, ascending.
using EdgePlaces = std::map<std::array<int, 2>, Vector3>;

/// Points along edges of a layout that are not straight, from the smaller node on.
using EdgePaths = std::map<std::array<int, 2>, std::vector<Vector3>>;

/// A layout whose sheets with new nodes are divided in two: all edges that face a given one in a
/// cuboid, and so on, get a node.
///
/// Old nodes come first and keep their numbers. Cuboids lie in the order of the old ones they are
/// of; a set holds the parts of its old sides.
///
/// @param places  of new nodes; the other edges of their sheets are divided in the mean ratio of
///                those that face them
/// @param paths   edges are divided at a point of these, if there is one between their ends
/// @throws InputError  for nodes that no cuboid has as an edge
[[nodiscard]] PlacedLayout divide_sheets(const PlacedLayout& placed, const EdgePlaces& places,
                                         const EdgePaths& paths = {});

}  // namespace couture::meshing
