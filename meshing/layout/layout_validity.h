#pragma once

#include <string>
#include <vector>

#include "meshing/layout/cap_pattern.h"
#include "meshing/layout/volumetric_layout.h"

namespace couture::meshing {

/// Whether quads are a layout of a surface, and whether cuboids can fill what it bounds.
struct LayoutVerdict {
    bool is_quad_layout = false;
    bool is_cuboid_configuration = false;
    /// The first rule that is broken, with the node or cycle; empty if none is.
    std::string reason;
};

/// A quad layout: quads around each node form one fan, inner nodes have at least three arcs, and
///     sum over inner nodes of (1 - v/4) + sum over boundary nodes of (3 - v)/4 = chi
/// with v arcs at a node. A cuboid configuration besides: boundary loops, which caps will close,
/// and other cycles that bound inside have an even number of nodes, at least 4; a closed one has an
/// even number of quads. Nodes without arcs don't count.
///
/// @param chi  Euler characteristic of the surface that the layout is drawn on
/// @param inside_cycles  nodes of cycles that bound inside the volume but not on its surface: one
///                       for each handle. Tunnels may have any number of nodes
/// @throws InputError  if two neighbours in a cycle have no arc between them
///
/// Source: [Maquart19] Eq. (6.8), (6.9). Differs: the boundary term there is 1 - v/3, which fails
/// for a single quad; and (6.9) there forbids odd tunnels, as of a ring of three cuboids.
[[nodiscard]] LayoutVerdict judge_layout(const QuadLayout& layout, int chi,
                                         const std::vector<std::vector<int>>& inside_cycles = {});

/// A pattern that closes a boundary loop, laid on it as match_caps lays caps on caps.
struct BoundaryCap {
    /// Of boundary_loops(layout).
    int loop = 0;
    CapPattern pattern;
    int rotation = 0;
};

/// The layout with some of its boundary loops closed; inner nodes of patterns are added at the end.
///
/// @throws InputError     if there is no such loop
/// @throws TopologyError  if loop and pattern have different numbers of nodes, or two nodes would
///                        have two arcs between them
///
/// Source: [Maquart19] Fig. 6.3
[[nodiscard]] QuadLayout close_boundaries(const QuadLayout& layout,
                                          const std::vector<BoundaryCap>& caps);

/// Of a volume in space.
struct VolumeTopology {
    int chi = 0;
    /// Connected components, tunnels, cavities.
    std::vector<int> betti;
    /// Of the components of its boundary, in the order of their smallest nodes.
    std::vector<int> genera;
};

/// @throws InputError, TopologyError  as layout_boundary; if the boundary touches itself at a node;
/// and
///                                    unless 2 chi(V) = chi(dV), chi(V) = sum of (1 - g_i), b_1 =
///                                    sum of g_i and b_2 = boundary components - b_0
///
/// Source: [Maquart19] Eq. (6.13), (6.15). Differs: sums over the boundary's components.
[[nodiscard]] VolumeTopology volume_topology(const VolumetricLayout& layout);

}  // namespace couture::meshing
