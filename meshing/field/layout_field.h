#pragma once

#include <vector>

#include "meshing/field/direction_field.h"
#include "meshing/layout/embedded_layout.h"

namespace couture::meshing {

struct LayoutFieldOptions {
    /// How much principal directions count next to smoothness (principal_targets); 0: not at all.
    double principal_strength = 1.0;
};

struct LayoutFieldReport {
    /// Of the squares of connection angles, with the topology alone and in the end.
    double topological_energy = 0.0;
    double energy = 0.0;
    /// Largest angle between the cross and an edge of a feature or boundary arc, in radians.
    double feature_angle = 0.0;
};

struct LayoutField {
    FieldTopology topology;
    DirectionField field;
    LayoutFieldReport report;
};

/// The cross field of a layout: its topology by a trivial connection; then the smoothest field of
/// this topology that runs along feature and boundary arcs and edges of feature curves inside quads
/// exactly, and near principal directions.
///
/// @param mesh  edges tagged with their features
/// @throws as topology_of_layout, check_topology, align_field
///
/// Source: [Maquart19] Sec. 4.1.3
[[nodiscard]] LayoutField make_layout_field(const SurfaceMesh& mesh,
                                            const EmbeddedLayout& embedding,
                                            const LayoutFieldOptions& options = {});

/// For each face the angle, in its frame, of that direction of the field that belongs to the first
/// axis of its quad's chart (along side 0 from corner 0): carried from face to face by the field's
/// period jumps and over arcs by the sides of quads, so that it does not depend on where the
/// directions of the field and the sides of quads point. One quarter turn for each component is
/// chosen, that which is nearest to its arcs.
///
/// @param field  with the topology of the layout (make_layout_field)
[[nodiscard]] std::vector<double> chart_directions(const SurfaceMesh& mesh,
                                                   const EmbeddedLayout& embedding,
                                                   const DirectionField& field);

}  // namespace couture::meshing
