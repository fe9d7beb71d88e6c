#include "meshing/layout/padded_ties.h"

#include <algorithm>
#include <utility>

#include "iga/core/error.h"
#include "meshing/layout/padding.h"

namespace couture::meshing {

namespace {

// Nodes behind the first one up to the last, over none that is taken: a sheet that ends beside an
// arc divides those that meet it.
std::vector<int> shortest_way(const QuadLayout& layout, const std::vector<bool>& is_taken, int from,
                              int to, const std::string& who) {
    if (layout.find_arc(from, to) >= 0) return {to};
    std::vector<std::vector<int>> neighbours(layout.n_nodes());
    for (const QuadLayout::Arc& arc : layout.arcs()) {
        neighbours[arc.from].push_back(arc.to);
        neighbours[arc.to].push_back(arc.from);
    }
    std::vector<int> before(layout.n_nodes(), -1);
    std::vector<int> queue{from};
    before[from] = from;
    for (std::size_t k = 0; k < queue.size() && before[to] < 0; ++k) {
        for (const int next : neighbours[queue[k]]) {
            if (before[next] >= 0 || (is_taken[next] && next != to)) continue;
            before[next] = queue[k];
            queue.push_back(next);
        }
    }
    if (before[to] < 0) {
        throw TopologyError(
            "layout: {}: padding leaves no way from node {} to node {} clear of other sharp edges: "
            "sheets of cuboids end beside it all around. Take other cuboids there, or let the "
            "edges "
            "around it be all sharp or all smooth (another feature angle)",
            who, layout.node_name(from), layout.node_name(to));
    }
    std::vector<int> way;
    for (int node = to; node != from; node = before[node]) way.push_back(node);
    std::ranges::reverse(way);
    return way;
}

}  // namespace

PaddedTies pad_with_ties(const VolumetricLayout& volume, std::vector<LayoutTie> ties) {
    const LayoutBoundary before = layout_boundary(volume);
    std::vector<bool> is_smooth(before.layout.n_arcs(), true);
    for (const LayoutTie& tie : ties) {
        if (!tie.is_feature || tie.is_blunt) continue;
        for (std::size_t k = 0; k + 1 < tie.nodes.size(); ++k) {
            is_smooth[before.layout.find_arc(tie.nodes[k], tie.nodes[k + 1])] = false;
        }
    }
    PaddedLayout padded = pad_layout(volume, is_smooth);
    const LayoutBoundary after = layout_boundary(padded.layout);
    std::vector<bool> is_taken(after.layout.n_nodes(), false);
    for (const LayoutTie& tie : ties) {
        for (const int node : tie.nodes) is_taken[padded.node_in_place[node]] = true;
    }
    for (LayoutTie& tie : ties) {
        std::vector<int> nodes{padded.node_in_place[tie.nodes[0]]};
        for (std::size_t k = 1; k < tie.nodes.size(); ++k) {
            const int next = padded.node_in_place[tie.nodes[k]];
            for (const int node :
                 shortest_way(after.layout, is_taken, nodes.back(), next, tie.name)) {
                nodes.push_back(node);
                is_taken[node] = true;
            }
        }
        tie.nodes = std::move(nodes);
    }
    return {std::move(padded.layout), std::move(ties), std::move(padded.node_in_place)};
}

void draw_decomposition(const VolumetricLayout& volume, std::vector<LayoutTie> ties,
                        CuboidDecomposition& decomposition) {
    PaddedTies padded = pad_with_ties(volume, std::move(ties));
    draw_decomposition(std::move(padded.volume), std::span(std::as_const(padded.ties)),
                       decomposition);
}

void draw_decomposition(VolumetricLayout padded, std::span<const LayoutTie> ties,
                        CuboidDecomposition& decomposition) {
    LayoutBoundary boundary = layout_boundary(padded);
    decomposition.volume = std::move(padded);
    decomposition.sides = std::move(boundary.sides);
    decomposition.surface = embed_layout(decomposition.mesh, boundary.layout, ties);
}

}  // namespace couture::meshing
