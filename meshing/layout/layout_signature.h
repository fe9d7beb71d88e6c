#pragma once

#include <array>
#include <string>
#include <vector>

#include "meshing/layout/volumetric_layout.h"

namespace couture::meshing {

/// For each cuboid the sheet of each of its directions: arcs that face each other in a cuboid
/// belong to one sheet and have the same number of elements. Counted in the order of cuboids, then
/// directions.
[[nodiscard]] std::vector<std::array<int, 3>> cuboid_sheets(const VolumetricLayout& layout);

/// Hash of nodes and cuboids as they are numbered, sets (in any order of their sides) and elements
/// of each sheet: 16 hexadecimal digits. Layouts with equal signatures and one knot vector per
/// sheet give multipatches with equal iga::signature.
///
/// @param n_cells  elements of each sheet of cuboid_sheets; each at least 1
/// @throws InputError  for a wrong number of sheets, or one without elements
[[nodiscard]] std::string layout_signature(const VolumetricLayout& layout,
                                           const std::vector<int>& n_cells);

}  // namespace couture::meshing
