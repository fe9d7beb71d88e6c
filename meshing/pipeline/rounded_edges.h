#pragma once

#include <vector>

#include "meshing/layout/cuboid_decomposition.h"

namespace couture::meshing {

/// What of a sharp edge of a surface no arc runs along that is made for it. Splines are smooth
/// inside the quads that it crosses, so that they round it: see VolumeDistance::rounded.
struct RoundedEdge {
    /// Number of the feature curve that it is part of.
    int curve = -1;
    /// Edges of the mesh, ascending.
    std::vector<EdgeHandle> edges;
    /// Of the edges together.
    double length = 0.0;
    /// The middle of the edge that is nearest to the centre of all.
    Vector3 place = Vector3::Zero();
};

/// In the order of their curves; none where all sharp edges are arcs.
[[nodiscard]] std::vector<RoundedEdge> find_rounded_edges(const CuboidDecomposition& cuboids);

}  // namespace couture::meshing
