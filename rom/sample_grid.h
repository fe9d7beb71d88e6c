#pragma once

#include <array>
#include <vector>

#include "iga/topology/space.h"

namespace couture::rom {

/// A tensor grid of points of a patch, first direction fastest.
struct SampleGrid {
    int patch = 0;
    /// Of each direction, rising. A side has one in the direction that it is normal to.
    std::array<std::vector<double>, 3> parameters;

    [[nodiscard]] std::array<int, 3> sizes() const;
    [[nodiscard]] int n_points() const;
    [[nodiscard]] Vector3 point(int i_point) const;
};

enum class SampleRegion {
    volume,      ///< a grid for each patch
    outer_sides  ///< a grid for each side that belongs to no interface
};

/// Grids with points at the ends of all elements and `n_cells - 1` equidistant ones between them.
/// On sides and edges that collapse the points move into the patch, by a millionth of the element:
/// there are no derivatives on them.
///
/// @param n_cells  per element and direction
/// @throws InputError  for fewer than 1
[[nodiscard]] std::vector<SampleGrid> make_sample_grids(const iga::Space<3>& space,
                                                        SampleRegion region, int n_cells = 1);

}  // namespace couture::rom
