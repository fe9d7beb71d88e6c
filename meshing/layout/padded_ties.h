#pragma once

#include <span>
#include <vector>

#include "meshing/layout/cuboid_decomposition.h"
#include "meshing/layout/embed_layout.h"

namespace couture::meshing {

/// A volumetric layout with sheets of cuboids where outer sides of one cuboid meet at no sharp
/// edge, with the ties on it.
struct PaddedTies {
    VolumetricLayout volume;
    std::vector<LayoutTie> ties;
    /// For each node before padding that which lies in its place.
    std::vector<int> node_in_place;
};

/// Arcs on ties of features that are not blunt are sharp, all others smooth (pad_layout). Nodes
/// of ties become those in their place; a sheet that ends beside an arc divides it.
///
/// @param ties  on the nodes of the volume
/// @throws InputError, TopologyError  as pad_layout; TopologyError if sheets leave a tie no arcs to
///                                    run along that no other tie takes: names the tie
[[nodiscard]] PaddedTies pad_with_ties(const VolumetricLayout& volume, std::vector<LayoutTie> ties);

/// Pads a volume and draws its boundary along ties on the mesh of a decomposition; sets the
/// decomposition's surface, volume and sides.
///
/// @throws TopologyError, GeometryError  as pad_with_ties and embed_layout
void draw_decomposition(const VolumetricLayout& volume, std::vector<LayoutTie> ties,
                        CuboidDecomposition& decomposition);
/// The same for a volume that is padded.
void draw_decomposition(VolumetricLayout padded, std::span<const LayoutTie> ties,
                        CuboidDecomposition& decomposition);

}  // namespace couture::meshing
