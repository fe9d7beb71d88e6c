#pragma once

#include <vector>

#include "iga/topology/multipatch.h"
#include "meshing/layout/cuboid_decomposition.h"

namespace couture::meshing {

/// How far the boundary of a volume is from the surface that it was made of, both ways, over the
/// diagonal of the surface's box.
struct VolumeDistance {
    double surface = 0.0;
    /// Between edges of patches along sharp edges and these; 0 if there are none.
    double features = 0.0;
    /// From sharp edges that no arc runs along to the splines, one way; 0 if there are none.
    double rounded = 0.0;
    /// The largest of each quad of the layout, and of each of its arcs along sharp edges; 0 for
    /// other arcs.
    std::vector<double> of_quads;
    std::vector<double> of_arcs;
};

/// Outer sides are sampled at `n_samples` equal parts of each element and direction.
///
/// @param volume  patch c is cuboid c of the decomposition
/// @throws InputError  for less than one part
[[nodiscard]] VolumeDistance volume_distance(const iga::MultiPatch<3>& volume,
                                             const CuboidDecomposition& cuboids, int n_samples = 4);

}  // namespace couture::meshing
