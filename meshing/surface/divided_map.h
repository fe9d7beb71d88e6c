#pragma once

#include <span>
#include <vector>

#include "meshing/surface/cut_surface.h"

namespace couture::meshing {

/// A map of a disc to a convex polygon for surfaces whose harmonic map is flipped by rounding, such
/// as long fingers, where it shrinks exponentially: where the mean value map of a piece flips, an
/// edge path through the flipped region is laid on a straight line across the polygon by arc
/// length, and the two pieces, whose polygons are convex again, are mapped alone. A triangle
/// without vertices on its sides is divided at an inner vertex instead.
///
/// Each division leaves fewer triangles, and a single triangle can't flip: without rounding it ends
/// for every disc none of whose chords joins two vertices of one side of the polygon. With
/// rounding, parts may come out too thin in the end: closed tubes of 3, 4 and 8 edges around are
/// mapped at lengths of 50, 100 and 300 radii, not at 100, 300 and 1000. The caller checks all
/// triangles.
///
/// @param boundary    the boundary loop, as halfedges in order
/// @param sides       for each of them the number of the polygon's side that it lies on
/// @param parameters  one per vertex: given on the boundary, filled inside
/// @return number of divisions
///
/// Source: bijective pieces by [Floater03].
int map_by_division(const CutSurface& disc, std::span<const int> boundary,
                    std::span<const int> sides, std::vector<Vector2>& parameters);

}  // namespace couture::meshing
