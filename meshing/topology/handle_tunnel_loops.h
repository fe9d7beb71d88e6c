#pragma once

#include <span>
#include <vector>

#include "meshing/surface/cut_surface.h"
#include "meshing/topology/integer_lattice.h"

namespace couture::meshing {

/// A simple closed edge path on a surface with its homology class.
struct HomologyLoop {
    /// In order, without the first one again at the end.
    std::vector<int> vertices;
    double length = 0.0;
    /// In Z^2g, see HomologyBasis.
    std::vector<int> homology_class;
};

/// Short handle and tunnel loops of a surface that bounds a solid.
struct HandleTunnelLoops {
    /// The surface that was given, with the edges split that let disjoint loops pass
    /// (`surface.splits()`). Loops are numbered in it.
    CutSurface surface;
    int genus = 0;
    /// By length; no vertex belongs to two handles, nor to two tunnels.
    std::vector<HomologyLoop> handles;
    std::vector<HomologyLoop> tunnels;
    /// Linking projector A: handles are the classes x with xA = 0, tunnels those with xA = x.
    IntegerMatrix projector;
    /// For each cut that was given whether it takes a handle off: whether its class is independent
    /// of those before it.
    std::vector<bool> is_handle_cut;
    /// Determinant of the classes of cuts and handles above those of tunnels, 1 or -1: together
    /// they are a homology basis.
    long long determinant = 1;
};

/// Short handle loops (that bound inside the solid) and tunnel loops (that bound outside): genus
/// many of each, simple, disjoint among their own kind, chosen greedily by length so that together
/// they form an integer homology basis. They never touch the boundary of the surface.
///
/// Shortest loops of classes through a vertex come from shortest-path trees; sources are the
/// vertices of the loops of the other kind, which every loop of this kind must cross: of long ones
/// 32 evenly spaced and those near the best. O(genus n log n) but for knotted tubes.
///
/// @param surface  connected, oriented outwards; holes are taken as closed by fans
/// @param cuts     disjoint simple closed edge paths, by vertices in order, that bound inside the
///                 solid: handles keep off them, and are fewer by the number of independent classes
///                 that the cuts have
/// @param needs_all_handles  whether the cuts must leave no handle
/// @throws TopologyError  if the surface is not connected, or no solid's boundary (see
///                        linking_projector), or a knotted tube needs classes beyond what is
///                        searched, or a cut does not bound inside,
///                        or if the cuts must take off all handles and don't
///
/// Source: [EricksonWhittlesey05]; [DeyLiSunCohenSteiner08]; [Maquart19] Sec. 2.1.2.4, 3.1.1.
/// Differs: no Reeb graph; handles and tunnels are told apart by exact linking numbers.
[[nodiscard]] HandleTunnelLoops find_handle_tunnel_loops(
    const CutSurface& surface, std::span<const std::vector<int>> cuts = {},
    bool needs_all_handles = false);

}  // namespace couture::meshing
