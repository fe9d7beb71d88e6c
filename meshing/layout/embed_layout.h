#pragma once

#include <span>
#include <string>
#include <vector>

#include "meshing/layout/embedded_layout.h"

namespace couture::meshing {

/// A path of the surface that arcs of a layout must follow: a feature curve, a cut, or a part of
/// one.
struct LayoutTie {
    /// An edge path; a closed one has its first vertex at the end again.
    std::vector<VertexHandle> vertices;
    /// Nodes of the layout along it, at least two; the first one lies at the first vertex, the last
    /// one at the last vertex, the others anywhere between, in this order.
    std::vector<int> nodes;
    bool is_feature = false;
    /// Of a feature: whether the solid fills too much around it for the corner of one cuboid (see
    /// the function is_blunt).
    bool is_blunt = false;
    /// Named in messages.
    std::string name;
};

/// Draws a layout on a surface along ties. Ties cut the surface and the layout into regions that
/// correspond; in each the remaining arcs are drawn.
///
/// Nodes on a tie that no end of a tie fixes lie where the tie is nearest to a node that an arc
/// joins them to, or are spread evenly. A region that is no disc is cut open along arcs by shortest
/// paths. A disc is mapped to a convex polygon whose corners are its nodes, and so are the quads
/// that belong to it (Tutte's embedding); then a path of arcs that divides it is drawn as straight
/// lines of the map, and the two parts are treated alike.
///
/// @param mesh    closed; refined where arcs need room. Numbers of curves on its edges are replaced
///                by those of arcs.
/// @param layout  closed and connected, or at least without boundary in what the ties leave
/// @param ties    together they must cut every region of the surface from every other one; no two
///                may cross
/// @return arcs as paths, numbers of quads for all faces
/// @throws TopologyError  if ties cross, name arcs that don't exist, put a node at two places, or
///                        leave a region of the surface that is not that of the layout; names the
///                        tie
/// @throws GeometryError  if an arc can't be drawn; names its nodes
///
/// Source: [Maquart19] Sec. 3.2.2. Differs: one map for each region, not three unit squares for
/// each pant, so that arcs can't cross.
[[nodiscard]] EmbeddedLayout embed_layout(SurfaceMesh& mesh, const QuadLayout& layout,
                                          std::span<const LayoutTie> ties);

}  // namespace couture::meshing
