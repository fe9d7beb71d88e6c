#include "meshing/layout/tied_nodes.h"

#include <algorithm>
#include <queue>
#include <tuple>

#include "iga/core/error.h"

namespace couture::meshing {

namespace {

// Edges that a tie has at least for each of its arcs.
constexpr int edges_per_arc = 3;
// Part of the way between two fixed nodes that those between keep from each other at least.
constexpr double smallest_gap = 0.1;

void check_tie(const SurfaceMesh& mesh, const QuadLayout& layout, const LayoutTie& tie) {
    if (tie.nodes.size() < 2 || tie.vertices.size() < 2) {
        throw TopologyError("{}: it has {} nodes and {} vertices; a tie has two of each at least",
                            tie.name, tie.nodes.size(), tie.vertices.size());
    }
    for (std::size_t k = 0; k + 1 < tie.nodes.size(); ++k) {
        if (layout.find_arc(tie.nodes[k], tie.nodes[k + 1]) < 0) {
            throw TopologyError("{}: no arc joins nodes {} and {} of the layout", tie.name,
                                layout.node_name(tie.nodes[k]), layout.node_name(tie.nodes[k + 1]));
        }
    }
    for (std::size_t k = 0; k + 1 < tie.vertices.size(); ++k) {
        if (!mesh.find_halfedge(tie.vertices[k], tie.vertices[k + 1]).is_valid()) {
            throw TopologyError("{}: vertices {} and {} have no common edge", tie.name,
                                tie.vertices[k].idx(), tie.vertices[k + 1].idx());
        }
    }
}

// Splits the longest edges until there is room for all nodes.
void refine_tie(SurfaceMesh& mesh, LayoutTie& tie) {
    const std::size_t needed = edges_per_arc * (tie.nodes.size() - 1);
    while (tie.vertices.size() - 1 < needed) {
        std::size_t longest = 0;
        double length = -1.0;
        for (std::size_t k = 0; k + 1 < tie.vertices.size(); ++k) {
            const double l = (mesh.point(tie.vertices[k]) - mesh.point(tie.vertices[k + 1])).norm();
            if (l > length * (1.0 + 1e-9)) {
                length = l;
                longest = k;
            }
        }
        const VertexHandle middle =
            split_edge(mesh, mesh.find_halfedge(tie.vertices[longest], tie.vertices[longest + 1]));
        tie.vertices.insert(tie.vertices.begin() + static_cast<std::ptrdiff_t>(longest) + 1,
                            middle);
    }
}

class Placement {
  public:
    Placement(const SurfaceMesh& mesh, const QuadLayout& layout, std::span<const LayoutTie> ties)
        : mesh_(mesh),
          layout_(layout),
          ties_(ties),
          place_(layout.n_nodes()),
          neighbours_(layout.n_nodes()) {
        std::vector<bool> is_tied(layout.n_arcs(), false);
        for (const LayoutTie& tie : ties) {
            for (std::size_t k = 0; k + 1 < tie.nodes.size(); ++k) {
                is_tied[layout.find_arc(tie.nodes[k], tie.nodes[k + 1])] = true;
            }
        }
        for (int a = 0; a < layout.n_arcs(); ++a) {
            if (is_tied[a]) continue;
            neighbours_[layout.arcs()[a].from].push_back(layout.arcs()[a].to);
            neighbours_[layout.arcs()[a].to].push_back(layout.arcs()[a].from);
        }
    }

    std::vector<VertexHandle> run() {
        fix_ends();
        find_floating();
        for (int node = 0; node < layout_.n_nodes(); ++node) {
            if (place_[node].vertex.is_valid()) offer_neighbours(node);
        }
        while (!offers_.empty()) {
            const auto [distance, node, from] = offers_.top();
            offers_.pop();
            if (place_[node].vertex.is_valid()) continue;
            fix(node, nearest(node, mesh_.point(place_[from].vertex)));
            offer_neighbours(node);
        }
        spread_rest();
        std::vector<VertexHandle> vertices(layout_.n_nodes());
        for (int node = 0; node < layout_.n_nodes(); ++node) vertices[node] = place_[node].vertex;
        return vertices;
    }

  private:
    struct Place {
        VertexHandle vertex;
        // Of a node between the ends of a tie: which one, which of its nodes, and at which of its
        // vertices it lies, -1 as long as it has none.
        int tie = -1;
        int position = -1;
        int index = -1;
    };

    void fix_ends() {
        for (const LayoutTie& tie : ties_) {
            fix_end(tie, tie.nodes.front(), tie.vertices.front());
            fix_end(tie, tie.nodes.back(), tie.vertices.back());
        }
    }

    void fix_end(const LayoutTie& tie, int node, VertexHandle vertex) {
        VertexHandle& fixed = place_[node].vertex;
        if (fixed.is_valid() && fixed != vertex) {
            throw TopologyError("{}: node {} of the layout would lie at vertices {} and {}",
                                tie.name, layout_.node_name(node), fixed.idx(), vertex.idx());
        }
        fixed = vertex;
    }

    void find_floating() {
        for (std::size_t t = 0; t < ties_.size(); ++t) {
            const LayoutTie& tie = ties_[t];
            for (std::size_t k = 1; k + 1 < tie.nodes.size(); ++k) {
                Place& place = place_[tie.nodes[k]];
                if (place.tie >= 0 || place.vertex.is_valid()) {
                    throw TopologyError("{}: node {} of the layout lies on another tie already",
                                        tie.name, layout_.node_name(tie.nodes[k]));
                }
                place.tie = static_cast<int>(t);
                place.position = static_cast<int>(k);
            }
        }
        length_.resize(ties_.size());
        for (std::size_t t = 0; t < ties_.size(); ++t) {
            length_[t].push_back(0.0);
            for (std::size_t k = 1; k < ties_[t].vertices.size(); ++k) {
                length_[t].push_back(length_[t].back() + (mesh_.point(ties_[t].vertices[k]) -
                                                          mesh_.point(ties_[t].vertices[k - 1]))
                                                             .norm());
            }
        }
    }

    void offer_neighbours(int from) {
        for (const int node : neighbours_[from]) {
            const Place& place = place_[node];
            if (place.tie < 0 || place.vertex.is_valid()) continue;
            const Vector3& x = mesh_.point(place_[from].vertex);
            const VertexHandle vertex = ties_[place.tie].vertices[nearest(node, x)];
            offers_.push({(mesh_.point(vertex) - x).norm(), node, from});
        }
    }

    // The node's range on its tie, as positions of the fixed nodes before and behind it.
    [[nodiscard]] std::pair<int, int> fixed_around(const Place& place) const {
        const LayoutTie& tie = ties_[place.tie];
        int before = place.position - 1;
        while (before > 0 && index_on(place.tie, before) < 0) --before;
        int behind = place.position + 1;
        while (behind + 1 < static_cast<int>(tie.nodes.size()) && index_on(place.tie, behind) < 0) {
            ++behind;
        }
        return {before, behind};
    }

    // Vertex of a tie at which a node of it lies; -1 if it has none yet.
    [[nodiscard]] int index_on(int t, int position) const {
        const LayoutTie& tie = ties_[t];
        if (position == 0) return 0;
        if (position + 1 == static_cast<int>(tie.nodes.size())) {
            return static_cast<int>(tie.vertices.size()) - 1;
        }
        return place_[tie.nodes[position]].index;
    }

    // The vertex of the node's tie nearest to x that leaves room for the other nodes.
    [[nodiscard]] int nearest(int node, const Vector3& x) const {
        const Place& place = place_[node];
        const auto [before, behind] = fixed_around(place);
        const int first = index_on(place.tie, before);
        const int last = index_on(place.tie, behind);
        const std::vector<double>& length = length_[place.tie];
        const double gap = smallest_gap * (length[last] - length[first]) / (behind - before - 1);
        const double low = length[first] + gap * (place.position - before);
        const double high = length[last] - gap * (behind - place.position);
        int best = -1;
        double distance = 0.0;
        for (int k = first + (place.position - before); k <= last - (behind - place.position);
             ++k) {
            const double outside = std::max({0.0, low - length[k], length[k] - high});
            const double d = (mesh_.point(ties_[place.tie].vertices[k]) - x).norm() + 1e6 * outside;
            if (best < 0 || d < distance) {
                best = k;
                distance = d;
            }
        }
        return best;
    }

    void fix(int node, int index) {
        Place& place = place_[node];
        place.index = index;
        place.vertex = ties_[place.tie].vertices[index];
    }

    // Nodes that no arc ties to a fixed one: evenly between those before and behind.
    void spread_rest() {
        for (int node = 0; node < layout_.n_nodes(); ++node) {
            const Place& place = place_[node];
            if (place.tie < 0 || place.vertex.is_valid()) continue;
            const auto [before, behind] = fixed_around(place);
            const int first = index_on(place.tie, before);
            const int last = index_on(place.tie, behind);
            const std::vector<double>& length = length_[place.tie];
            const double aim = length[first] + (length[last] - length[first]) *
                                                   (place.position - before) / (behind - before);
            int best = first + (place.position - before);
            for (int k = best; k <= last - (behind - place.position); ++k) {
                if (std::abs(length[k] - aim) < std::abs(length[best] - aim)) best = k;
            }
            fix(node, best);
        }
    }

    const SurfaceMesh& mesh_;
    const QuadLayout& layout_;
    std::span<const LayoutTie> ties_;
    std::vector<Place> place_;
    // Through arcs on no tie.
    std::vector<std::vector<int>> neighbours_;
    // Along each tie up to each of its vertices.
    std::vector<std::vector<double>> length_;
    // Distance, node, the fixed node that it is near to; the smallest first.
    std::priority_queue<std::tuple<double, int, int>, std::vector<std::tuple<double, int, int>>,
                        std::greater<>>
        offers_;
};

}  // namespace

std::vector<VertexHandle> place_tied_nodes(SurfaceMesh& mesh, const QuadLayout& layout,
                                           std::vector<LayoutTie>& ties) {
    for (LayoutTie& tie : ties) {
        check_tie(mesh, layout, tie);
        refine_tie(mesh, tie);
    }
    return Placement(mesh, layout, ties).run();
}

}  // namespace couture::meshing
