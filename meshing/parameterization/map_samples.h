#pragma once

#include "meshing/layout/layout_samples.h"
#include "meshing/parameterization/layout_map.h"

namespace couture::meshing {

/// The surface's points at the grid points of a map's charts: corners of cells and, between them,
/// those of `n_per_cell` equal parts. Nodes are exactly where they are, feature and boundary arcs'
/// points on their edges.
///
/// From a corner of each chart on, faces are unfolded across every edge that meets the inside of
/// the chart, until they cover it.
///
/// @param n_per_cell  1: the cells themselves
/// @throws InputError     for less than one part
/// @throws GeometryError  if a grid point is not covered; names quad and point
[[nodiscard]] LayoutSamples sample_layout_map(const SurfaceMesh& mesh,
                                              const EmbeddedLayout& embedding, const LayoutMap& map,
                                              int n_per_cell = 1);

}  // namespace couture::meshing
