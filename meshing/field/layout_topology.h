#pragma once

#include <vector>

#include "meshing/field/dual_tree.h"
#include "meshing/field/field_topology.h"
#include "meshing/field/trivial_connection.h"
#include "meshing/layout/embedded_layout.h"

namespace couture::meshing {

/// The topology of the cross field that runs along the arcs of a layout: index 4 - v at an inner
/// node of valence v; sum of (3 - v) over the nodes of a boundary; along a generator, for each
/// visit to a quad, -1, 0 or 1 if it leaves by the side on the right of, opposite to or on the left
/// of the one where it entered, and +2 or -2 if it leaves by that side again, left or right of
/// where it entered. Nothing is rounded.
///
/// @throws TopologyError  if an arc does not run along edges of the mesh, or the layout's quads are
///                        not those beside its arcs; names the arc
///
/// Source: [Maquart19] Table 4.1, [CampenKobbelt14]. Differs: signs, and generators by sides of
/// quads, which need no homotopic cycle along arcs.
[[nodiscard]] FieldTopology topology_of_layout(const SurfaceMesh& mesh,
                                               const EmbeddedLayout& embedding,
                                               const DualCycles& cycles);

/// What the angle of a face has to change by so that its cross lies along an edge of an arc.
struct ArcOffset {
    int arc = 0;
    FaceHandle face;
    /// Radians; not to be reduced.
    double offset = 0.0;
    /// Length of the edge.
    double length = 0.0;
};

/// Offsets of a field with the topology of a layout, integrated from the root of a tree, for both
/// faces of each edge of each arc; all against the same quarter turn of the cross at the root.
/// Taken together as they are they leave the topology as it is: turns of the arcs against the
/// tree's paths are counted from quad to quad.
///
/// @param tree  with roots at arcs (faces_at_arcs)
[[nodiscard]] std::vector<ArcOffset> offsets_of_arcs(const SurfaceMesh& mesh,
                                                     const EmbeddedLayout& embedding,
                                                     const Connection& connection,
                                                     const DualTree& tree, double angle_at_root);

/// Faces with an edge on an arc, ascending.
[[nodiscard]] std::vector<FaceHandle> faces_at_arcs(const SurfaceMesh& mesh,
                                                    const EmbeddedLayout& embedding);

}  // namespace couture::meshing
