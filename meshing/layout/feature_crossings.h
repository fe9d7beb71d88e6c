#pragma once

#include <vector>

#include "meshing/layout/divide_sheets.h"
#include "meshing/layout/embed_layout.h"
#include "meshing/layout/quad_layout.h"
#include "meshing/surface/surface_mesh.h"

namespace couture::meshing {

/// Where features that no arc runs along cross arcs of a layout, so that they run through quads
/// from one side to the opposite one: a sheet that is divided there has arcs that follow them.
///
/// An arc crosses a feature that separates the smooth faces at its ends, where the feature is
/// nearest to the straight line between these; an arc along another feature where the one ends at
/// it. Both arcs of a pair of opposite sides must cross one, and nowhere along their sheet may it
/// turn in a quad from one side to the next.
///
/// @param mesh       with numbers of features and of their smooth faces; edges of drawn arcs have
///                   curves
/// @param layout     the boundary of a volumetric one
/// @param positions  of its nodes
/// @param ties       of the drawn arcs
[[nodiscard]] EdgePlaces feature_crossings(const SurfaceMesh& mesh, const QuadLayout& layout,
                                           const std::vector<Vector3>& positions,
                                           const std::vector<LayoutTie>& ties);

}  // namespace couture::meshing
