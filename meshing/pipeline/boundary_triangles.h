#pragma once

#include "iga/topology/multipatch.h"
#include "meshing/layout/cuboid_decomposition.h"
#include "meshing/volume/boundary_features.h"

namespace couture::meshing {

/// The boundary of a volume as triangles, with the layout of its patches drawn on it: cuboid p is
/// patch p, arcs are edges of outer sides. Each spline element of an outer side becomes
/// `n_per_element` x `n_per_element` cells of two triangles, with the shorter diagonal; their
/// vertices lie on the splines.
///
/// Feature curves and corners are those of `features`, wherever the volume's state has moved them;
/// named corners stay, too.
///
/// @param volume    a state of the body from which `features` were found
/// @param features  of any state of the body
/// @return templates empty; the record has the elements of the sheets and the sets
/// @throws TopologyError  if the signature is not that of the features, if a set names a side, an
///                        edge or a corner inside the volume, or as layout_of_volume and
///                        layout_boundary
/// @throws InputError     for less than one cell, or patches that are left-handed
[[nodiscard]] CuboidDecomposition triangulate_boundary(const iga::MultiPatch<3>& volume,
                                                       const BoundaryFeatures& features,
                                                       int n_per_element);

}  // namespace couture::meshing
