#include "meshing/layout/volumetric_layout.h"

#include <algorithm>

#include "iga/core/error.h"

namespace couture::meshing {

namespace {

void check_nodes(const VolumetricLayout& layout) {
    for (int c = 0; c < layout.n_cuboids(); ++c) {
        std::array<int, 8> nodes = layout.cuboids[c];
        std::ranges::sort(nodes);
        if (nodes.front() < 0 || nodes.back() >= layout.n_nodes) {
            throw InputError("cuboid {} of the layout has node {}; nodes are 0 to {}", c,
                             nodes.front() < 0 ? nodes.front() : nodes.back(), layout.n_nodes - 1);
        }
        const auto twice = std::ranges::adjacent_find(nodes);
        if (twice != nodes.end()) {
            throw InputError("cuboid {} of the layout has node {} twice", c,
                             node_name(layout.node_names, *twice));
        }
    }
}

// Names of some nodes.
std::string names_of(const VolumetricLayout& layout, const std::array<int, 4>& nodes) {
    std::vector<std::string> names;
    for (const int node : nodes) names.push_back(node_name(layout.node_names, node));
    return fmt::format("{}", fmt::join(names, ", "));
}

// The quad that starts with its smallest node.
std::array<int, 4> rotated_to_smallest(std::array<int, 4> quad) {
    std::ranges::rotate(quad, std::ranges::min_element(quad));
    return quad;
}

}  // namespace

const std::array<int, 4>& side_corners(int side) {
    static const std::array<std::array<int, 4>, 6> corners{
        {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};
    return corners.at(side);
}

std::array<int, 4> VolumetricLayout::nodes_of(const CuboidSide& side) const {
    std::array<int, 4> nodes{};
    for (int k = 0; k < 4; ++k) {
        nodes[k] = cuboids.at(side.cuboid)[side_corners(side.side)[k]];
    }
    return nodes;
}

std::vector<std::array<int, 4>> quads_of(const VolumetricLayout& layout,
                                         const std::vector<CuboidSide>& sides) {
    std::vector<std::array<int, 4>> quads;
    quads.reserve(sides.size());
    for (const CuboidSide& side : sides) quads.push_back(layout.nodes_of(side));
    return quads;
}

LayoutBoundary layout_boundary(const VolumetricLayout& layout) {
    check_nodes(layout);
    std::map<std::array<int, 4>, std::vector<CuboidSide>> sides_of_face;
    for (int c = 0; c < layout.n_cuboids(); ++c) {
        for (int side = 0; side < 6; ++side) {
            std::array<int, 4> nodes = layout.nodes_of({c, side});
            std::ranges::sort(nodes);
            sides_of_face[nodes].push_back({c, side});
        }
    }
    LayoutBoundary boundary;
    for (const auto& [nodes, sides] : sides_of_face) {
        if (sides.size() == 1) {
            boundary.sides.push_back(sides[0]);
            continue;
        }
        if (sides.size() > 2) {
            throw TopologyError("cuboids {}, {} and {} of the layout share the face of nodes {}",
                                sides[0].cuboid, sides[1].cuboid, sides[2].cuboid,
                                names_of(layout, nodes));
        }
        std::array<int, 4> opposite = layout.nodes_of(sides[1]);
        std::ranges::reverse(opposite);
        if (rotated_to_smallest(layout.nodes_of(sides[0])) != rotated_to_smallest(opposite)) {
            throw TopologyError(
                "cuboids {} and {} of the layout share the nodes {}, but don't lie on two sides of "
                "one face: renumber the corners of one",
                sides[0].cuboid, sides[1].cuboid, names_of(layout, nodes));
        }
    }
    std::ranges::sort(boundary.sides);
    boundary.layout =
        QuadLayout(layout.n_nodes, quads_of(layout, boundary.sides), layout.node_names);
    return boundary;
}

}  // namespace couture::meshing
