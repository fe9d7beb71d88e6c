#pragma once

#include <vector>

#include "meshing/surface/cut_surface.h"

namespace couture::meshing {

/// make_square(n) in its plane with every vertex moved at random: those inside by less than 0.2 of
/// the spacing in each direction, those on sides along them; corners stay.
[[nodiscard]] TriangleSoup make_jittered_square(int n, unsigned seed);

/// make_square(n) with the height `height` sin(7 x) cos(5 y) + x y.
[[nodiscard]] TriangleSoup make_bumpy_square(int n, double height);

/// make_tube closed at its upper end by a fan around a tip at height `length` (1 + 1 / n_along): a
/// disc whose boundary is the lower circle.
[[nodiscard]] TriangleSoup make_finger(int n_around, int n_along, double radius, double length);

/// Corners of make_square(n), counter-clockwise from the origin.
[[nodiscard]] std::vector<int> square_corner_vertices(int n);

/// Shortest path (by number of edges, through vertices inside) from one boundary loop to another
/// one, as halfedges.
[[nodiscard]] std::vector<int> path_between_boundaries(const CutSurface& surface, int from_loop,
                                                       int to_loop);

/// n vertices of a disc's boundary at about the same distances along it, counter-clockwise.
[[nodiscard]] std::vector<int> spread_corners(const CutSurface& disc, int n);

}  // namespace couture::meshing
