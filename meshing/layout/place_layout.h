#pragma once

#include <limits>

#include "meshing/layout/cuboid_decomposition.h"
#include "meshing/layout/volumetric_layout.h"

namespace couture::meshing {

/// Draws the boundary of a coarse mesh of cuboids, which lies about where the solid does, on the
/// solid's surface, padded where it needs it: where outer sides of one cuboid meet at a smooth arc
/// or at a feature with an interior angle of more than 120 degrees, around which the corners of two
/// cuboids are better.
///
/// Feature corners take the nearest nodes, one to one; then nodes with two or more sharp arcs that
/// are near a feature curve lie on it, and arcs between nodes on features follow these where the
/// way along them is about as short as the arc. Then it is padded. Where that does not cut the surface into discs,
/// arcs are drawn as shortest paths near to their straight lines, until it does; nodes on them lie
/// where the surface is nearest. The remaining arcs are those of embed_layout. A feature along
/// which no arc runs is treated as smooth, see untied_length.
///
/// @param mesh      closed, with numbers of features on its edges
/// @param features  its own
/// @param most_reach  no node moves farther to a feature, but for the length of an edge
/// @return templates empty; sets are those of the layout
/// @throws TopologyError  if surface and layout have different Euler characteristics, or no feature
///                        of the surface runs along arcs of the layout
/// @throws TopologyError, GeometryError  if an arc can't be drawn: names its nodes
[[nodiscard]] CuboidDecomposition place_layout(
    const SurfaceMesh& mesh, const Features& features, const PlacedLayout& placed,
    double most_reach = std::numeric_limits<double>::infinity());

/// Length of the feature edges of a decomposition's mesh that lie on no arc.
[[nodiscard]] double untied_length(const CuboidDecomposition& decomposition);

}  // namespace couture::meshing
