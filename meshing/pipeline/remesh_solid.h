#pragma once

#include "meshing/pipeline/solid_mesh.h"
#include "meshing/volume/optimize_volume.h"

namespace couture::meshing {

/// What became of a body that was meshed again.
struct RemeshedSolid {
    /// With the patches, knots, interfaces and sets of the body.
    iga::MultiPatch<3> volume;
    /// Triangles of the body's boundary.
    int n_triangles = 0;
    NodeRelocationReport relocation;
    /// From the new map's elements to those of `volume`.
    VolumeOptimizationReport optimization;
    /// Of `volume` from the triangles.
    VolumeDistance distance;
    /// (new - old) / old.
    double volume_change = 0.0;
};

/// The same body in new splines: its boundary is triangulated, mapped anew to the layout of its
/// patches (mesh_solid), with nodes at better places, and filled again; then control points slide
/// within the new boundary until the worst elements are better (optimize_volume). Its feature
/// curves are followed; corners stay.
///
/// @param deformed  a state of the body from which `features` were found; B-splines without weights
/// @throws GeometryError  if the boundary meets itself (names how often and where), if the new
///                        volume is not certified, and as mesh_solid and optimize_volume
/// @throws InputError     for patches with weights
/// @throws InputError, TopologyError  as triangulate_boundary
///
/// Source: [Maquart19] Sec. 7.1.2.3, 6.3.4.
[[nodiscard]] RemeshedSolid remesh_solid(const iga::MultiPatch<3>& deformed,
                                         const BoundaryFeatures& features);

/// Whether remesh_solid can take the body: its patches, sets and weights, not its shape.
///
/// @throws InputError, TopologyError  as remesh_solid
void check_remeshable(const iga::MultiPatch<3>& body, const BoundaryFeatures& features);

}  // namespace couture::meshing
