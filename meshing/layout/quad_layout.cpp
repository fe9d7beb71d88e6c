#include "meshing/layout/quad_layout.h"

#include <algorithm>
#include <numeric>

#include "iga/core/error.h"

namespace couture::meshing {

namespace {

std::pair<int, int> in_order(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

void check_corners(const std::array<int, 4>& quad, int number, int n_nodes,
                   const std::vector<std::string>& names) {
    for (int k = 0; k < 4; ++k) {
        if (quad[k] < 0 || quad[k] >= n_nodes) {
            throw InputError("quad {} of the layout has corner {}; nodes are 0 to {}", number,
                             quad[k], n_nodes - 1);
        }
        for (int l = 0; l < k; ++l) {
            if (quad[k] == quad[l]) {
                throw InputError("quad {} of the layout has node {} twice", number,
                                 node_name(names, quad[k]));
            }
        }
    }
}

}  // namespace

QuadLayout::QuadLayout(int n_nodes, std::vector<std::array<int, 4>> quads,
                       std::vector<std::string> node_names)
    : n_nodes_(n_nodes), quads_(std::move(quads)), node_names_(std::move(node_names)) {
    for (int q = 0; q < n_quads(); ++q) {
        check_corners(quads_[q], q, n_nodes, node_names_);
        for (int k = 0; k < 4; ++k) {
            arc_of_nodes_.emplace(in_order(quads_[q][k], quads_[q][(k + 1) % 4]), 0);
        }
    }
    for (auto& [nodes, number] : arc_of_nodes_) {
        number = n_arcs();
        arcs_.push_back({nodes.first, nodes.second});
    }
    arc_quads_.resize(arcs_.size());
    sides_.resize(quads_.size());
    for (int q = 0; q < n_quads(); ++q) {
        for (int k = 0; k < 4; ++k) {
            const int from = quads_[q][k];
            const int to = quads_[q][(k + 1) % 4];
            const int arc = find_arc(from, to);
            sides_[q][k] = {arc, from < to};
            ArcQuad& place = arc_quads_[arc][from < to ? 0 : 1];
            if (place.quad >= 0) {
                throw TopologyError(
                    "quads {} and {} of the layout both run from node {} to node {}: turn one "
                    "over, or take one away where more than two meet",
                    place.quad, q, node_name(from), node_name(to));
            }
            place = {q, k};
        }
    }
}

std::string QuadLayout::node_name(int node) const { return meshing::node_name(node_names_, node); }

std::string QuadLayout::arc_name(int arc) const {
    return fmt::format("{} and {}", node_name(arcs_[arc].from), node_name(arcs_[arc].to));
}

std::string QuadLayout::quad_name(int quad) const {
    std::array<std::string, 4> names;
    std::ranges::transform(quads_[quad], names.begin(), [&](int node) { return node_name(node); });
    return fmt::format("{}", fmt::join(names, ", "));
}

int QuadLayout::find_arc(int from, int to) const {
    const auto found = arc_of_nodes_.find(in_order(from, to));
    return found == arc_of_nodes_.end() ? -1 : found->second;
}

std::vector<int> QuadLayout::valences() const {
    std::vector<int> valences(n_nodes_, 0);
    for (const Arc& arc : arcs_) {
        ++valences[arc.from];
        ++valences[arc.to];
    }
    return valences;
}

int QuadLayout::euler_characteristic() const {
    const std::vector<int> valence = valences();
    const auto n_unused = std::ranges::count(valence, 0);
    return n_nodes_ - static_cast<int>(n_unused) - n_arcs() + n_quads();
}

std::vector<bool> QuadLayout::boundary_nodes() const {
    std::vector<bool> on_boundary(n_nodes_, false);
    for (int a = 0; a < n_arcs(); ++a) {
        if (is_boundary_arc(a)) {
            on_boundary[arcs_[a].from] = true;
            on_boundary[arcs_[a].to] = true;
        }
    }
    return on_boundary;
}

std::vector<int> QuadLayout::sheets() const {
    std::vector<int> sheet(arcs_.size(), -1);
    int n_sheets = 0;
    for (int first = 0; first < n_arcs(); ++first) {
        if (sheet[first] >= 0) {
            continue;
        }
        std::vector<int> open{first};
        sheet[first] = n_sheets;
        while (!open.empty()) {
            const int arc = open.back();
            open.pop_back();
            for (const ArcQuad& place : arc_quads_[arc]) {
                if (place.quad < 0) {
                    continue;
                }
                const int facing = sides_[place.quad][(place.side + 2) % 4].arc;
                if (sheet[facing] < 0) {
                    sheet[facing] = n_sheets;
                    open.push_back(facing);
                }
            }
        }
        ++n_sheets;
    }
    return sheet;
}

std::string node_name(const std::vector<std::string>& names, int node) {
    const auto n = static_cast<std::size_t>(node);
    return n < names.size() && !names[n].empty() ? fmt::format("'{}'", names[n])
                                                 : std::to_string(node);
}

std::vector<std::vector<int>> boundary_loops(const QuadLayout& layout) {
    std::map<int, int> next;
    for (int a = 0; a < layout.n_arcs(); ++a) {
        if (!layout.is_boundary_arc(a)) continue;
        auto [from, to] = layout.arcs()[a];
        if (layout.arc_quads(a)[0].quad < 0) std::swap(from, to);
        if (!next.emplace(from, to).second) {
            throw TopologyError(
                "the boundary of the layout passes node {} twice: quads touch there at the node "
                "only",
                layout.node_name(from));
        }
    }
    std::vector<std::vector<int>> loops;
    while (!next.empty()) {
        std::vector<int>& loop = loops.emplace_back();
        for (auto at = next.begin(); at != next.end(); at = next.find(loop.back())) {
            if (loop.empty()) loop.push_back(at->first);
            loop.push_back(at->second);
            next.erase(at);
        }
        loop.pop_back();
    }
    return loops;
}

}  // namespace couture::meshing
