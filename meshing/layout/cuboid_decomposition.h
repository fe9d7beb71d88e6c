#pragma once

#include <string>
#include <vector>

#include "meshing/layout/cuboid_template.h"
#include "meshing/layout/embedded_layout.h"
#include "meshing/layout/layout_record.h"
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
    /// For each arc of the surface the length that it should have; empty: any.
    std::vector<double> arc_lengths;
    /// For each patch of the decomposition the name of its template.
    std::vector<std::string> templates;
    /// What was decided, for other members of the family; without elements.
    LayoutRecord record;
};

/// Chooses a template for each patch, glues the templates along the cuts and draws their boundary
/// on the surface.
///
/// @param opened    with numbers of features and of the decomposition's curves on its edges
/// @param caps      what closes its boundary loops
/// @throws TopologyError  if the solid has a cavity, if no template fits a patch (names the patch,
///                        how many feature curves and corners it has, and the templates that there
///                        are), if no choice fits across the cuts, or as embed_layout
///
/// Source: [Maquart19] Sec. 3.2, 3.3.2.
[[nodiscard]] CuboidDecomposition decompose_into_cuboids(
    const SurfaceMesh& opened, const Features& features, const PantsDecomposition& pants,
    const ClosingCaps& caps, const TemplateLibrary& library, const MatchOptions& options = {});

/// The same for another member of a family, with what was decided on the first one: its templates,
/// laid on corresponding features, its sets.
///
/// @param pants   cut as the first member was (replay_pants)
/// @param record  carried over to this member (carry_over)
/// @throws TopologyError  if features don't match those of the first member (see repeat_choice), if
///                        a recorded set is not on the boundary, or as embed_layout
/// @throws InputError     if the library lacks a recorded template
///
/// Source: [Maquart19] Sec. 5.1, 6.3.4.
[[nodiscard]] CuboidDecomposition repeat_cuboids(
    const SurfaceMesh& opened, const Features& features, const PantsDecomposition& pants,
    const ClosingCaps& caps, const TemplateLibrary& library, const LayoutRecord& record);

}  // namespace couture::meshing
