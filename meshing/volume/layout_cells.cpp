#include "meshing/volume/layout_cells.h"

#include <algorithm>
#include <map>
#include <queue>

namespace couture::meshing {

namespace {

using Edge = LayoutCells::Edge;

// Nodes of edge i of a cuboid from the low to the high end of its direction.
std::pair<int, int> edge_nodes(const std::array<int, 8>& cuboid, int i) {
    const int k = i / 4;
    const auto [a, b] = iga::tangential_directions<3>(2 * k);
    const int corner = (i & 1) << a | (i >> 1 & 1) << b;
    return {cuboid[corner], cuboid[corner | 1 << k]};
}

Edge make_edge(int node, int other) { return {std::min(node, other), std::max(node, other)}; }

// The frame that follows from the numbers.
std::array<int, 4> canonical(const std::array<int, 4>& nodes) {
    const int at = static_cast<int>(std::ranges::min_element(nodes) - nodes.begin());
    int first = nodes[at ^ 1];
    int second = nodes[at ^ 2];
    if (first > second) std::swap(first, second);
    return {nodes[at], first, second, nodes[at ^ 3]};
}

void number_faces(const VolumetricLayout& layout, LayoutCells& cells) {
    std::map<std::array<int, 4>, int> known;
    cells.cuboid_faces.resize(layout.n_cuboids());
    for (int c = 0; c < layout.n_cuboids(); ++c) {
        for (int side = 0; side < 6; ++side) {
            const auto nodes = canonical(side_nodes(layout, {c, side}));
            const auto [place, is_new] = known.try_emplace(nodes, cells.faces.size());
            if (is_new) {
                cells.faces.push_back(
                    {nodes,
                     {cells.find_edge(nodes[0], nodes[1]), cells.find_edge(nodes[2], nodes[3]),
                      cells.find_edge(nodes[0], nodes[2]), cells.find_edge(nodes[1], nodes[3])},
                     {}});
            }
            cells.cuboid_faces[c][side] = place->second;
            cells.faces[place->second].sides.push_back({c, side});
        }
    }
}

// Walks through each sheet from its smallest edge.
void find_sheets(const VolumetricLayout& layout, LayoutCells& cells) {
    struct Neighbour {
        int edge;
        bool is_reversed;
    };
    std::vector<std::vector<Neighbour>> neighbours(cells.edges.size());
    for (int c = 0; c < layout.n_cuboids(); ++c) {
        for (int i = 0; i < 12; ++i) {
            const int first = cells.cuboid_edges[c][i - i % 4];
            const int second = cells.cuboid_edges[c][i];
            const auto [a, b] = edge_nodes(layout.cuboids[c], i - i % 4);
            const auto [p, q] = edge_nodes(layout.cuboids[c], i);
            neighbours[first].push_back({second, (a < b) != (p < q)});
            neighbours[second].push_back({first, (a < b) != (p < q)});
        }
    }
    cells.sheets.assign(cells.edges.size(), -1);
    cells.runs_against_sheet.assign(cells.edges.size(), false);
    for (std::size_t start = 0; start < cells.edges.size(); ++start) {
        if (cells.sheets[start] >= 0) continue;
        const int sheet = cells.n_sheets();
        cells.is_twisted_sheet.push_back(false);
        cells.sheets[start] = sheet;
        std::queue<int> front;
        front.push(static_cast<int>(start));
        while (!front.empty()) {
            const int edge = front.front();
            front.pop();
            for (const auto& [next, is_reversed] : neighbours[edge]) {
                const bool against = cells.runs_against_sheet[edge] != is_reversed;
                if (cells.sheets[next] < 0) {
                    cells.sheets[next] = sheet;
                    cells.runs_against_sheet[next] = against;
                    front.push(next);
                } else if (cells.runs_against_sheet[next] != against) {
                    cells.is_twisted_sheet[sheet] = true;
                }
            }
        }
    }
}

}  // namespace

int LayoutCells::find_edge(int node, int other) const {
    const Edge edge = make_edge(node, other);
    const auto place = std::ranges::lower_bound(edges, edge);
    return place != edges.end() && *place == edge ? static_cast<int>(place - edges.begin()) : -1;
}

LayoutCells make_layout_cells(const VolumetricLayout& layout) {
    (void)layout_boundary(layout);
    LayoutCells cells;
    for (const auto& cuboid : layout.cuboids) {
        for (int i = 0; i < 12; ++i) {
            const auto [a, b] = edge_nodes(cuboid, i);
            cells.edges.push_back(make_edge(a, b));
        }
    }
    std::ranges::sort(cells.edges);
    const auto rest = std::ranges::unique(cells.edges);
    cells.edges.erase(rest.begin(), rest.end());
    for (const auto& cuboid : layout.cuboids) {
        auto& edges = cells.cuboid_edges.emplace_back();
        for (int i = 0; i < 12; ++i) {
            const auto [a, b] = edge_nodes(cuboid, i);
            edges[i] = cells.find_edge(a, b);
        }
    }
    number_faces(layout, cells);
    find_sheets(layout, cells);
    return cells;
}

std::array<int, 4> side_nodes(const VolumetricLayout& layout, const CuboidSide& side) {
    const auto [a, b] = iga::tangential_directions<3>(side.side);
    const int base = iga::side_is_high(side.side) ? 1 << iga::side_direction(side.side) : 0;
    const auto& nodes = layout.cuboids.at(side.cuboid);
    return {nodes[base], nodes[base | 1 << a], nodes[base | 1 << b], nodes[base | 1 << a | 1 << b]};
}

iga::SideMap<3> map_of_nodes(const std::array<int, 4>& first, const std::array<int, 4>& second) {
    const auto place = [&](int node) {
        return static_cast<int>(std::ranges::find(second, node) - second.begin());
    };
    const int origin = place(first[0]);
    iga::SideMap<3> map;
    for (int i = 0; i < 2; ++i) {
        map.axis[i] = (place(first[i + 1]) ^ origin) == 1 ? 0 : 1;
        map.reversed[i] = (origin >> map.axis[i] & 1) != 0;
    }
    return map;
}

std::vector<int> grid_places(const iga::SideMap<3>& map, const std::array<int, 2>& sizes) {
    std::vector<int> places;
    places.reserve(static_cast<std::size_t>(sizes[0]) * sizes[1]);
    for (int j = 0; j < sizes[map.axis[1]]; ++j) {
        for (int i = 0; i < sizes[map.axis[0]]; ++i) {
            std::array<int, 2> at{};
            at[map.axis[0]] = map.reversed[0] ? sizes[map.axis[0]] - 1 - i : i;
            at[map.axis[1]] = map.reversed[1] ? sizes[map.axis[1]] - 1 - j : j;
            places.push_back(at[0] + sizes[0] * at[1]);
        }
    }
    return places;
}

}  // namespace couture::meshing
