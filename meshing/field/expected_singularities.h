#pragma once

#include <vector>

#include "meshing/field/field_topology.h"
#include "meshing/surface/surface_mesh.h"

namespace couture::meshing {

struct ExpectedSingularities {
    /// Of a cross field, by ascending vertices; all indices +1 or -1.
    std::vector<Singularity> singularities;
    /// Turns of the field along each boundary (FieldTopology), by its corners.
    std::vector<int> boundary_turns;
    /// Curvature that the clusters and the corners of the boundary have beyond what their
    /// singularities stand for, radians: the two sides of (2.26b), without the index formula,
    /// apart.
    double residual = 0.0;
    /// Quarter turns that neither gives; as many singularities (+1 or -1) lie elsewhere.
    int n_missing = 0;
};

/// Singularities of a cross field where the surface is curved: in each curvature cluster as many of
/// a quarter turn as its curvature asks for, the first where it is curved most and each other one
/// farthest from those before; what is missing to the index formula likewise among all inner
/// vertices. A boundary turns by a quarter at each of its corners.
///
/// @throws TopologyError  if there are not enough inner vertices
///
/// Source: [Maquart19] Eq. (2.26b), (2.27)
[[nodiscard]] ExpectedSingularities expected_singularities(const SurfaceMesh& mesh);

}  // namespace couture::meshing
