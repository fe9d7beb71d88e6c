#pragma once

#include <array>
#include <functional>
#include <vector>

#include "iga/core/types.h"

namespace couture::meshing {

/// Triangles in the plane.
struct PlanarMesh {
    /// Those of the loops first, in their order, then the inner ones.
    std::vector<Vector2> points;
    /// Point numbers, counter-clockwise.
    std::vector<std::array<int, 3>> triangles;
};

/// Wanted length of edges at a place of the plane, positive.
using PlanarSize = std::function<double(const Vector2&)>;

/// Triangulates the region left of some closed polygons; their edges stay as they are.
///
/// Constrained Delaunay triangulation; circumcentres of triangles that are too large are inserted,
/// the largest first, unless they come near another point or the boundary; then inner points move
/// to the weighted mean of their triangles' centroids and the triangulation is made anew.
/// Depends on the input only: the same bits each time.
///
/// @param loops  outer loop counter-clockwise, holes clockwise; at least three points each
/// @throws GeometryError  if edges cross or touch, a point stands twice, or nothing lies inside
///
/// Source: [Ruppert95] for the insertion of circumcentres; Differs: boundary edges are never split,
/// so there is no bound on angles. [ChenHolst11] for the moves (centroids of patches).
[[nodiscard]] PlanarMesh mesh_planar_region(const std::vector<std::vector<Vector2>>& loops,
                                            const PlanarSize& size);

}  // namespace couture::meshing
