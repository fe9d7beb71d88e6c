#pragma once

#include "meshing/surface/surface_mesh.h"

namespace couture::tests {

/// The same surface, open or closed, with triangles of another size, and its vertices and triangles
/// in another order.
///
/// @param soup         oriented, a manifold
/// @param edge_length  of the new triangles, about
/// @param seed         of the order
[[nodiscard]] meshing::TriangleSoup remeshed(const meshing::TriangleSoup& soup, double edge_length,
                                             unsigned seed);

}  // namespace couture::tests
