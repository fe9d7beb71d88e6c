#pragma once

#include <vector>

#include "meshing/layout/cuboid_template.h"
#include "meshing/layout/layout_choice.h"
#include "meshing/layout/patch_features.h"
#include "meshing/topology/pants.h"

namespace couture::meshing {

/// Decides where nodes lie on cuts that no sharp edge meets: the place of the first one, which of
/// the templates' nodes come there on both sides, and which of a template's caps it is.
///
/// Places of nodes along all loops of a patch have a harmonic map of the patch into the space of
/// its template. Its energy is least where arcs from loop to loop are not twisted, however the
/// patch is bent. The sum over all patches is lowered cut by cut until no change helps, and no
/// exchange of two caps of a patch without sharp edges.
///
/// @param opened   with numbers of the decomposition's curves on its edges
/// @param patches  loops at such cuts are turned: their first vertex is that of their first node
/// @param choice   of choose_layout; caps, loop nodes and rotations are changed
///
/// Source: [Maquart19] Eq. (2.30)-(2.32) for the maps. Differs: there the nodes are picked by hand.
void turn_smooth_cuts(const SurfaceMesh& opened, const PantsDecomposition& pants,
                      const TemplateLibrary& library, std::vector<PatchFeatures>& patches,
                      LayoutChoice& choice);

}  // namespace couture::meshing
