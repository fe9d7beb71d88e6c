#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "iga/core/types.h"
#include "meshing/layout/quad_layout.h"

namespace couture::meshing {

/// A side of a cuboid: 2 * direction + (0 low, 1 high), as of a patch.
struct CuboidSide {
    int cuboid = -1;
    int side = -1;
    auto operator<=>(const CuboidSide&) const = default;
};

/// Corners (0 to 7) of a cuboid's side, counter-clockwise seen from outside.
[[nodiscard]] const std::array<int, 4>& side_corners(int side);

/// A coarse hexahedral mesh, combinatorics only. Cuboids are glued where they share the nodes of a
/// face.
///
/// Source: [Maquart19] Def. 6.5.
struct VolumetricLayout {
    int n_nodes = 0;
    /// Corner i lies at (i & 1, i >> 1 & 1, i >> 2 & 1) of the unit cube; right-handed.
    std::vector<std::array<int, 8>> cuboids;
    /// Named outer sides.
    std::map<std::string, std::vector<CuboidSide>> sets;
    /// That messages call nodes by: of the first ones, empty for none.
    std::vector<std::string> node_names = {};

    [[nodiscard]] int n_cuboids() const { return static_cast<int>(cuboids.size()); }
    /// Nodes of a side, counter-clockwise seen from outside the cuboid.
    [[nodiscard]] std::array<int, 4> nodes_of(const CuboidSide& side) const;
};

/// A volumetric layout with a place for each node.
struct PlacedLayout {
    VolumetricLayout layout;
    std::vector<Vector3> positions;
};

/// Nodes of each side, as nodes_of.
[[nodiscard]] std::vector<std::array<int, 4>> quads_of(const VolumetricLayout& layout,
                                                       const std::vector<CuboidSide>& sides);

/// The boundary of a volumetric layout, by the nodes of the volume.
struct LayoutBoundary {
    QuadLayout layout;
    /// The side that each quad is; corner k of the quad is side_corners(side)[k] of the cuboid.
    std::vector<CuboidSide> sides;
};

/// Sides that no two cuboids share, in the order of their cuboid and side.
///
/// @throws InputError     for a node out of range or one that stands twice in a cuboid
/// @throws TopologyError  for a face of more than two cuboids, two cuboids that lie on the same
/// side
///                        of a face, or a boundary that is no manifold; names the cuboids and nodes
[[nodiscard]] LayoutBoundary layout_boundary(const VolumetricLayout& layout);

}  // namespace couture::meshing
