#pragma once

#include <limits>

#include "meshing/layout/cuboid_decomposition.h"
#include "meshing/layout/volumetric_layout.h"

namespace couture::meshing {

struct PlaceLayoutOptions {
    /// No node moves farther to a feature, but for the length of an edge.
    double most_reach = std::numeric_limits<double>::infinity();
    /// Whether sheets of cuboids are divided where features cross them that no arc runs along.
    bool divides_sheets = true;
};

/// Draws the boundary of a coarse mesh of cuboids, which lies about where the solid does, on the
/// solid's surface, padded where it needs it: where outer sides of one cuboid meet at a smooth arc
/// or at a feature with an interior angle of more than 120 degrees, around which the corners of two
/// cuboids are better.
///
/// Arcs that lie near features are tied to these (tie_features). Sheets that other features cross
/// are divided there (feature_crossings, divide_sheets), as long as features with arcs are a
/// twentieth longer then. Then it is padded and more arcs are drawn where the surface is not cut
/// into discs yet (cut_into_discs). The remaining arcs are those of embed_layout. A feature along
/// which no arc runs is treated as smooth, see untied_length.
///
/// @param mesh      closed, with numbers of features on its edges
/// @param features  its own
/// @return templates empty; sets are those of the layout; arcs should be as long as they are in it,
///         but on features, where they should stay as they are
/// @throws TopologyError  if surface and layout have different Euler characteristics, if none of
///                        the surface's features runs along arcs of the layout, or if it has no
///                        features and a node lies far from it
/// @throws GeometryError  if the cuboids lie inside out
/// @throws TopologyError, GeometryError  if an arc can't be drawn: names its nodes
[[nodiscard]] CuboidDecomposition place_layout(const SurfaceMesh& mesh, const Features& features,
                                               const PlacedLayout& placed,
                                               const PlaceLayoutOptions& options = {});

/// Length of the feature edges of a decomposition's mesh that lie on no arc.
[[nodiscard]] double untied_length(const CuboidDecomposition& decomposition);

}  // namespace couture::meshing
