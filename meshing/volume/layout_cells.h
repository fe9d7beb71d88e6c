#pragma once

#include <array>
#include <vector>

#include "iga/topology/multipatch.h"
#include "meshing/layout/volumetric_layout.h"

namespace couture::meshing {

/// Edges and faces of a volumetric layout, each once, with directions that follow from the numbers
/// of their nodes alone; and its sheets.
struct LayoutCells {
    struct Edge {
        /// The smaller node first.
        int from = 0;
        int to = 0;
        auto operator<=>(const Edge&) const = default;
    };
    struct Face {
        /// At (0, 0), (1, 0), (0, 1), (1, 1): first the smallest node, then the smaller one of its
        /// neighbours.
        std::array<int, 4> nodes{};
        /// Along the first direction at its low and high end of the second, then along the second.
        std::array<int, 4> edges{};
        /// One, or two inside the volume.
        std::vector<CuboidSide> sides;
    };

    /// Ascending.
    std::vector<Edge> edges;
    /// In the order of the first side that shows them.
    std::vector<Face> faces;
    /// For each cuboid, 4 per direction: 4 direction + i + 2 j at the ends i and j of the other
    /// two, ascending.
    std::vector<std::array<int, 12>> cuboid_edges;
    std::vector<std::array<int, 6>> cuboid_faces;

    /// For each edge the number of its sheet: edges that face each other in a cuboid belong to the
    /// same one. Counted in the order of their smallest edge.
    std::vector<int> sheets;
    /// For each edge whether it runs against the smallest one of its sheet.
    std::vector<bool> runs_against_sheet;
    /// For each sheet whether it comes back to itself reversed, like a Moebius strip.
    std::vector<bool> is_twisted_sheet;

    [[nodiscard]] int n_sheets() const { return static_cast<int>(is_twisted_sheet.size()); }
    /// -1 if there is none.
    [[nodiscard]] int find_edge(int node, int other) const;
};

/// @throws InputError, TopologyError  as layout_boundary
[[nodiscard]] LayoutCells make_layout_cells(const VolumetricLayout& layout);

/// Nodes of a cuboid's side at (0, 0), (1, 0), (0, 1), (1, 1) of its tangential directions,
/// ascending.
[[nodiscard]] std::array<int, 4> side_nodes(const VolumetricLayout& layout, const CuboidSide& side);

/// How the directions of one quad run on another with the same nodes, both at (0, 0), (1, 0),
/// (0, 1), (1, 1).
[[nodiscard]] iga::SideMap<3> map_of_nodes(const std::array<int, 4>& first,
                                           const std::array<int, 4>& second);

/// For the points of a grid on the first quad, first direction fastest, their places in a grid on
/// the second.
///
/// @param sizes  points per direction of the second
[[nodiscard]] std::vector<int> grid_places(const iga::SideMap<3>& map,
                                           const std::array<int, 2>& sizes);

}  // namespace couture::meshing
