#pragma once

#include <map>
#include <vector>

#include "meshing/layout/volumetric_layout.h"

namespace couture::meshing {

/// Outer arcs at which the two outer sides are of one cuboid although the wall is smooth there: its
/// Jacobian determinant vanishes along them. Three outer sides of a cuboid meet in pairs at arcs.
///
/// @param is_smooth  for each arc of layout_boundary(layout).layout whether the interior angle
///                   between its sides reaches 150 degrees, on some member of the family
/// @return numbers of arcs, ascending
/// @throws InputError, TopologyError  as layout_boundary, and for a wrong number of arcs
[[nodiscard]] std::vector<int> flat_arcs(const VolumetricLayout& layout,
                                         const std::vector<bool>& is_smooth);

/// A layout with sheets of cuboids along its wall.
struct PaddedLayout {
    /// The old cuboids and nodes come first and keep their numbers, but old nodes at a sheet lie
    /// inside now, or on the sides where the sheet ends. Sets hold what lies where their sides lay,
    /// names go to the nodes in place.
    VolumetricLayout layout;
    /// For each old node that which lies in its place.
    std::vector<int> node_in_place;
    /// The outer side in the place of each old one, which may have lost strips at its border.
    std::map<CuboidSide, CuboidSide> side_in_place;
    /// Outer sides that are such strips, with the old side that they were part of: of the cuboids
    /// at the end of a sheet.
    std::map<CuboidSide, CuboidSide> strips;
    /// For each arc of layout_boundary(layout).layout, as given.
    std::vector<bool> is_smooth;
    int n_sheets = 0;
};

/// Inserts a sheet of cuboids below the outer sides in one: each chosen side gets a cuboid of its
/// own, which ends where a chosen side meets another one.
///
/// @param sides  outer sides; around each node they form at most one fan
/// @param is_smooth  as of flat_arcs
/// @throws InputError     for a side that is no outer one, or a wrong number of arcs
/// @throws TopologyError  if they form two fans at a node
[[nodiscard]] PaddedLayout insert_sheet(const VolumetricLayout& layout,
                                        const std::vector<CuboidSide>& sides,
                                        const std::vector<bool>& is_smooth);

/// Inserts sheets until no cuboid has outer sides that meet at a smooth arc. A sheet lies below
/// whole smooth parts of the wall, so that it ends at sharp arcs only: closed on itself, or on
/// caps, where a cap of one quad becomes one of five.
///
/// @throws InputError, TopologyError  as flat_arcs
[[nodiscard]] PaddedLayout pad_layout(const VolumetricLayout& layout,
                                      const std::vector<bool>& is_smooth);

}  // namespace couture::meshing
