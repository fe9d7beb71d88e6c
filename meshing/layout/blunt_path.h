#pragma once

#include <span>

#include "meshing/surface/surface_mesh.h"

namespace couture::meshing {

/// Whether along a path the corners of two cuboids, whose scaled Jacobian at an interior angle is
/// sin(angle / 2), are better than those of one with sin(angle): by the least of each, where parts
/// of less than a tenth of the length don't count. At one angle all along it is 120 degrees from
/// which that is so.
///
/// @param path  an edge path of a surface that is oriented outwards; edges of the boundary don't
///              count
[[nodiscard]] bool is_blunt(const SurfaceMesh& mesh, std::span<const VertexHandle> path);

}  // namespace couture::meshing
