#pragma once

#include <array>
#include <string>
#include <vector>

#include "meshing/layout/cuboid_template.h"

namespace couture::meshing {

/// A unit cube by its least corner.
using GridCell = std::array<int, 3>;
/// A unit square of a section, (y, z) of its least corner.
using SectionCell = std::array<int, 2>;

struct PolycubeCap {
    std::string name;
    /// Cuboids by their numbers in the list of cells.
    std::vector<CuboidSide> sides;
};

/// Unit cubes glued where they touch; nodes in the order of (x, y, z).
///
/// @throws InputError, TopologyError  for a cell that is there twice, and as check_template
[[nodiscard]] CuboidTemplate make_polycube_template(std::string name,
                                                    const std::vector<GridCell>& cells,
                                                    const std::vector<PolycubeCap>& caps);

/// One sector of a section along x, closed at x_high, with the cap "x_low".
[[nodiscard]] CuboidTemplate make_disc_template(std::string name,
                                                const std::vector<SectionCell>& section);

/// A section swept along x over 2 n + 1 sectors for n branches, with the caps "x_low" and "x_high".
/// Branch i stands on sector 2 i + 1: one cuboid on each cell of its chain, towards +y, with the
/// cap "branch" ("branch_1", "branch_2", ... of several). No branch: a cylinder; one: a pant.
///
/// @param branches  for each a chain of cells of the section of equal y and consecutive z whose
///                  sides towards +y are free, and stay free of the branch beside it
/// @throws InputError, TopologyError  if a chain is none of that, naming its cell; and as
///                                    check_template
///
/// Source: [Maquart19] Fig. 3.11
[[nodiscard]] CuboidTemplate make_bar_template(
    std::string name, const std::vector<SectionCell>& section,
    const std::vector<std::vector<SectionCell>>& branches);

/// A section swept around the z axis, cut open: along x over `n_corners` + 1 sectors that follow a
/// polygon, from the middle of one of its sides back to it, with the caps "x_low" and "x_high" at
/// the same place there. y points towards the axis. Glued to itself it is a ring.
///
/// @param n_corners  at least 3
/// @throws InputError, TopologyError  for fewer corners or no section; and as check_template
[[nodiscard]] CuboidTemplate make_ring_template(std::string name,
                                                const std::vector<SectionCell>& section,
                                                int n_corners);

/// One cuboid with a leg of one cuboid on its first `n_legs` sides of x_low, x_high, y_low, y_high,
/// z_low, z_high; the caps have their names.
///
/// @param n_legs  3 to 6
/// @throws InputError  for another number
[[nodiscard]] CuboidTemplate make_star_template(std::string name, int n_legs);

}  // namespace couture::meshing
