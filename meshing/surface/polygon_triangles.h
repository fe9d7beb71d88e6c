#pragma once

#include <array>
#include <span>
#include <vector>

#include "iga/core/types.h"

namespace couture::meshing {

/// Largest number of corners that `split_polygon` takes: its work grows with the square.
constexpr std::size_t max_polygon_corners = 10000;

/// Triangles of a polygon in space without new points, turned as the polygon is. Of a quad the
/// shorter diagonal is drawn (from its first corner if both are equally long) unless it lies
/// outside, so that one of the two triangles would be turned over. Larger polygons lose the corner
/// with the shortest diagonal one after the other, of those whose triangle is turned as the whole
/// polygon and holds no other corner, both in the plane of the polygon's mean normal.
///
/// @param points   of the surface
/// @param polygon  numbers of its corners in order, three or more, no two in a row the same
/// @return point numbers, `polygon.size()` - 2 triangles
/// @throws InputError  for fewer than three corners or more than `max_polygon_corners`
[[nodiscard]] std::vector<std::array<int, 3>> split_polygon(std::span<const Vector3> points,
                                                            std::span<const int> polygon);

}  // namespace couture::meshing
