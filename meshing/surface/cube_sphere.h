#pragma once

#include "meshing/surface/quad_grid.h"

namespace couture::meshing {

/// The unit sphere as the image of a cube: 6 n^2 quads between 6 n^2 + 2 points, whose numbers and
/// places follow from n alone. Lines of a face are great circles at equal angles.
///
/// @param n  quads along each edge of the cube, 1 to 1000
/// @throws InputError  for another n
///
/// Source: [RonchiIaconoPaolucci96].
[[nodiscard]] QuadMesh make_cube_sphere(int n);

}  // namespace couture::meshing
