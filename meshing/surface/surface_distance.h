#pragma once

#include <array>
#include <span>
#include <vector>

#include "meshing/surface/surface_mesh.h"

namespace couture::meshing {

using SpaceTriangle = std::array<Vector3, 3>;

[[nodiscard]] std::vector<SpaceTriangle> triangles_of(const SurfaceMesh& mesh);

/// Distance between two sets of triangles (or segments, whose last two points are the same), both
/// ways: the largest of those from the corners and the centre of one to the nearest place of the
/// other. A length.
///
/// @throws InputError  if one is empty
[[nodiscard]] double hausdorff_distance(std::span<const SpaceTriangle> first,
                                        std::span<const SpaceTriangle> second);

}  // namespace couture::meshing
