#pragma once

#include <span>
#include <vector>

#include "meshing/surface/surface_mesh.h"

namespace couture::meshing {

/// An edge of a soup as one of its triangles runs along it.
struct SoupSide {
    /// Vertex numbers of its ends.
    int low = -1;
    int high = -1;
    int triangle = -1;
    /// Whether the triangle runs from `low` to `high`.
    bool is_forward = true;

    [[nodiscard]] int from() const { return is_forward ? low : high; }
    [[nodiscard]] int to() const { return is_forward ? high : low; }
};

/// All sides of all triangles, three each, sorted by low end, high end, triangle: those of one edge
/// stand together. O(n log n).
[[nodiscard]] std::vector<SoupSide> sorted_sides(const TriangleSoup& soup);

/// Sorted sides, one span per edge, in their order; they point into `sides`.
[[nodiscard]] std::vector<std::span<const SoupSide>> edges_of(std::span<const SoupSide> sides);

/// Numbers of the components that triangles form across common edges, however many triangles those
/// have: 0, 1, ... in the order of their first triangle.
[[nodiscard]] std::vector<int> edge_components(const TriangleSoup& soup);

/// The triangles of a soup with these numbers, in this order, and all of its points.
[[nodiscard]] TriangleSoup part_of(const TriangleSoup& soup, std::span<const int> triangles);

/// Drops points of no triangle; the others keep their order.
///
/// @return how many were dropped
int drop_unused_points(TriangleSoup& soup);

/// Diagonal of the bounding box of the points; 0 without points.
[[nodiscard]] double bounding_box_diagonal(std::span<const Vector3> points);

}  // namespace couture::meshing
