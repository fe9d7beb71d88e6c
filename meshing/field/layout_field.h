#pragma once

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

}  // namespace couture::meshing
