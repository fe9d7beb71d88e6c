#pragma once

#include <array>
#include <span>
#include <vector>

#include "meshing/surface/surface_mesh.h"

namespace couture::meshing {

using SpaceTriangle = std::array<Vector3, 3>;

[[nodiscard]] std::vector<SpaceTriangle> triangles_of(const SurfaceMesh& mesh);

/// For each of the first triangles (or segments, whose last two points are the same) the largest
/// distance between it and the second ones, both ways: from its corners and its centre to the
/// nearest place of the second ones, and from the corners and centres of those to which it is
/// nearest. Lengths.
///
/// @throws InputError  if one set is empty
[[nodiscard]] std::vector<double> triangle_distances(std::span<const SpaceTriangle> first,
                                                     std::span<const SpaceTriangle> second);

/// Distance between two sets of triangles (or segments, whose last two points are the same), both
/// ways: the largest of triangle_distances. A length.
///
/// @throws InputError  if one is empty
[[nodiscard]] double hausdorff_distance(std::span<const SpaceTriangle> first,
                                        std::span<const SpaceTriangle> second);

}  // namespace couture::meshing
