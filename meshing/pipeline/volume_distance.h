#pragma once

#include <array>
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
    /// For each quad the element that has it: its number along the quad's sides 0 and 1.
    std::vector<std::array<int, 2>> worst_elements;
    std::vector<double> of_arcs;
};

/// Outer sides are sampled at `n_samples` equal parts of each element and direction.
///
/// @param volume  patch c is cuboid c of the decomposition
/// @throws InputError  for less than one part
[[nodiscard]] VolumeDistance volume_distance(const iga::MultiPatch<3>& volume,
                                             const CuboidDecomposition& cuboids, int n_samples = 4);

/// The same of splines for its boundary alone.
///
/// @param surfaces  in the order of the decomposition's quads (see make_layout_surfaces)
[[nodiscard]] VolumeDistance volume_distance(const iga::MultiPatch<2>& surfaces,
                                             const CuboidDecomposition& cuboids, int n_samples = 4);

}  // namespace couture::meshing
