#pragma once

#include <string>
#include <vector>

#include "meshing/layout/cuboid_template.h"
#include "meshing/layout/embedded_layout.h"
#include "meshing/layout/template_match.h"
#include "meshing/surface/caps.h"
#include "meshing/surface/features.h"
#include "meshing/topology/pants.h"

namespace couture::meshing {

/// A solid divided into cuboids: a volumetric layout whose boundary is drawn on the surface.
struct CuboidDecomposition {
    /// The closed surface, refined where arcs needed room.
    SurfaceMesh mesh;
    /// Of the boundary, by the nodes of the volume.
    EmbeddedLayout surface;
    /// Its sets are the caps, by the names of the boundary curves ("cap_1", ... where they have
    /// none).
    VolumetricLayout volume;
    /// The side that each quad of the surface is.
    std::vector<CuboidSide> sides;
    /// For each patch of the decomposition the name of its template.
    std::vector<std::string> templates;
};

/// Chooses a template for each patch, glues the templates along the cuts and draws their boundary
/// on the surface.
///
/// @param opened    with numbers of features and of the decomposition's curves on its edges
/// @param caps      what closes its boundary loops
/// @throws TopologyError  if no template fits a patch (names the patch, how many feature curves and
///                        corners it has, and the templates that there are), if no choice fits
///                        across the cuts, or as embed_layout
///
/// Source: [Maquart19] Sec. 3.2, 3.3.2.
[[nodiscard]] CuboidDecomposition decompose_into_cuboids(
    const SurfaceMesh& opened, const Features& features, const PantsDecomposition& pants,
    const ClosingCaps& caps, const TemplateLibrary& library, const MatchOptions& options = {});

}  // namespace couture::meshing
