#pragma once

#include <span>
#include <vector>

#include "meshing/layout/embed_layout.h"
#include "meshing/layout/padding.h"

namespace couture::meshing {

/// Corners of outer sides that are flat on the surface: both arcs there are tied, and the angle
/// between them, inside the side, reaches 150 degrees. Faces meet where arcs are tied to features.
///
/// @param mesh  that the ties lie on
/// @param ties  of two nodes each
[[nodiscard]] FlatCorners flat_corners(const SurfaceMesh& mesh, const LayoutBoundary& boundary,
                                       std::span<const LayoutTie> ties);

}  // namespace couture::meshing
