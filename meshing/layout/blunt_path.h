#pragma once

#include <span>

#include "meshing/surface/surface_mesh.h"

namespace couture::meshing {

/// Whether the solid fills more than 120 degrees around a tenth of a path's length or more: beyond
/// it the corners of two cuboids, whose scaled Jacobian there is sin(angle / 2), are better than
/// that of one with sin(angle).
///
/// @param path  an edge path of a surface that is oriented outwards; edges of the boundary don't
///              count
[[nodiscard]] bool is_blunt(const SurfaceMesh& mesh, std::span<const VertexHandle> path);

}  // namespace couture::meshing
