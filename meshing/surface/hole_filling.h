#pragma once

#include <array>
#include <span>
#include <vector>

#include "iga/core/types.h"

namespace couture::meshing {

/// Triangles that fill a closed polyline in space, without new points: of the triangulations of
/// the Delaunay tetrahedra's faces, else of all, the one with the smallest largest angle between
/// neighbours, then the smallest area. Seen with the polyline counter-clockwise, the triangles are
/// too.
///
/// @param loop  in order, the first point not repeated; three or more, all different
/// @return numbers of points of the loop, `loop.size()` - 2 triangles; none if there is no
///         triangulation
/// @throws InputError  for fewer than three points
///
/// Source: [Liepa03]
[[nodiscard]] std::vector<std::array<int, 3>> fill_loop(std::span<const Vector3> loop);

}  // namespace couture::meshing
