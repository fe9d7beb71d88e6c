#pragma once

#include <cstddef>
#include <vector>

#include "meshing/surface/surface_mesh.h"

namespace couture::meshing {

/// Two triangles that meet elsewhere than in the vertices or the edge that they share.
struct TriangleCrossing {
    /// Triangle numbers.
    int first = -1;
    /// Above `first`.
    int second = -1;
    /// A point of both, up to rounding; of coplanar ones a point near their overlap.
    Vector3 position = Vector3::Zero();
};

struct SelfIntersections {
    /// By `first`, then `second`.
    std::vector<TriangleCrossing> crossings;
    /// Whether there may be more: the search stopped at the largest number.
    bool is_cut_short = false;
};

/// Triangles of a soup that cross or touch each other, or lie folded on each other along a common
/// edge. The soup need not be a manifold; points count as shared if they have one number. Triangles
/// whose corners lie on a line, and those with the same three vertices as another one, are passed
/// over: they are told of by `check_solid`. Exact for the coordinates as they are stored.
/// O(n log n) where boxes around the triangles overlap few others.
///
/// @param max_crossings  at most so many are returned, the first ones in their order
/// @throws InputError  for vertex numbers that do not exist
///
/// Source: [MollerTrumbore97] for positions
[[nodiscard]] SelfIntersections find_self_intersections(const TriangleSoup& soup,
                                                        std::size_t max_crossings = 10000);

}  // namespace couture::meshing
