#include "meshing/layout/layout_validity.h"

#include <algorithm>
#include <numeric>
#include <optional>

#include "iga/core/disjoint_sets.h"
#include "iga/core/error.h"
#include "meshing/topology/cell_complex.h"

namespace couture::meshing {

namespace {

/// A node around which quads form more than one fan.
std::optional<int> find_pinched_node(const QuadLayout& layout) {
    DisjointSets fans(static_cast<std::size_t>(4) * layout.n_quads());
    const auto corner = [](const QuadLayout::ArcQuad& place, int k) {
        return 4 * place.quad + (place.side + k) % 4;
    };
    for (int a = 0; a < layout.n_arcs(); ++a) {
        if (layout.is_boundary_arc(a)) continue;
        const auto& [left, right] = layout.arc_quads(a);
        fans.join(corner(left, 0), corner(right, 1));
        fans.join(corner(left, 1), corner(right, 0));
    }
    std::vector<int> fan_of_node(layout.n_nodes(), -1);
    for (int i = 0; i < 4 * layout.n_quads(); ++i) {
        const int node = layout.quads()[i / 4][i % 4];
        if (fan_of_node[node] < 0) fan_of_node[node] = fans.find(i);
        if (fan_of_node[node] != fans.find(i)) return node;
    }
    return {};
}

/// What keeps it from being a layout of a surface; empty if nothing does.
std::string fault_of_layout(const QuadLayout& layout, int chi) {
    if (const auto node = find_pinched_node(layout)) {
        return fmt::format("quads touch at node {} only; around a node they form one fan",
                           layout.node_name(*node));
    }
    const std::vector<int> valence = layout.valences();
    const std::vector<bool> on_boundary = layout.boundary_nodes();
    int four_sum = 0;
    std::optional<int> irregular;
    for (int node = 0; node < layout.n_nodes(); ++node) {
        if (valence[node] == 0) continue;
        if (!on_boundary[node] && valence[node] < 3) {
            return fmt::format("inner node {} has {} arcs; at least 3 must meet",
                               layout.node_name(node), valence[node]);
        }
        const int term = on_boundary[node] ? 3 - valence[node] : 4 - valence[node];
        four_sum += term;
        if (term != 0 && !irregular) irregular = node;
    }
    if (four_sum == 4 * chi) return {};
    const std::string where =
        irregular
            ? fmt::format("; first irregular node: {} ({}valence {})", layout.node_name(*irregular),
                          on_boundary[*irregular] ? "on the boundary, " : "", valence[*irregular])
            : "; all nodes are regular";
    return fmt::format(
        "sum of (1 - valence/4) over inner and of (3 - valence)/4 over boundary nodes = {}, "
        "expected Euler characteristic {}{}",
        four_sum / 4.0, chi, where);
}

/// What is wrong with a cycle that bounds inside; empty if nothing is.
std::string fault_of_cycle(const std::vector<int>& cycle, const std::string& what) {
    if (cycle.size() % 2 == 0 && cycle.size() >= 4) return {};
    return fmt::format(
        "{} of {} nodes ({}) bounds inside; such a cycle has an even number of nodes, at least 4",
        what, cycle.size(), fmt::join(cycle, ", "));
}

std::string fault_of_configuration(const QuadLayout& layout,
                                   const std::vector<std::vector<int>>& inside_cycles) {
    const auto loops = boundary_loops(layout);
    for (const auto& loop : loops) {
        if (auto fault = fault_of_cycle(loop, "the boundary loop"); !fault.empty()) return fault;
    }
    for (const auto& cycle : inside_cycles) {
        if (auto fault = fault_of_cycle(cycle, "the cycle"); !fault.empty()) return fault;
    }
    if (loops.empty() && layout.n_quads() % 2 == 1) {
        return fmt::format("{} quads bound the volume; cuboids have an even number outside",
                           layout.n_quads());
    }
    return {};
}

void check_cycle(const QuadLayout& layout, const std::vector<int>& cycle) {
    for (std::size_t i = 0; i < cycle.size(); ++i) {
        const int next = cycle[(i + 1) % cycle.size()];
        if (layout.find_arc(cycle[i], next) < 0) {
            throw InputError("nodes {} and {} of the cycle ({}) have no arc between them", cycle[i],
                             next, fmt::join(cycle, ", "));
        }
    }
}

QuadLayout closed_by(const QuadLayout& layout, const std::vector<int>& loop,
                     const BoundaryCap& cap) {
    const int n = static_cast<int>(loop.size());
    if (static_cast<int>(cap.pattern.loop.size()) != n) {
        throw TopologyError(
            "the boundary loop of {} nodes ({}) can't be closed by a pattern of {} nodes", n,
            fmt::join(loop, ", "), cap.pattern.loop.size());
    }
    std::map<int, int> node;
    for (int k = 0; k < n; ++k) {
        node[cap.pattern.loop[k]] = loop[((cap.rotation - k) % n + n) % n];
    }
    int n_nodes = layout.n_nodes();
    std::vector<std::array<int, 4>> quads = layout.quads();
    for (std::array<int, 4> quad : cap.pattern.quads) {
        for (int& corner : quad) {
            const auto [at, is_new] = node.emplace(corner, n_nodes);
            n_nodes += is_new ? 1 : 0;
            corner = at->second;
        }
        quads.push_back(quad);
    }
    return {n_nodes, std::move(quads)};
}

/// Genus of each component of a closed layout.
std::vector<int> component_genera(const QuadLayout& layout) {
    DisjointSets parts(layout.n_nodes());
    for (const auto& arc : layout.arcs()) parts.join(arc.from, arc.to);
    std::map<int, int> chi;
    const std::vector<int> valence = layout.valences();
    for (int node = 0; node < layout.n_nodes(); ++node) {
        if (valence[node] > 0) ++chi[parts.find(node)];
    }
    for (const auto& arc : layout.arcs()) --chi[parts.find(arc.from)];
    for (const auto& quad : layout.quads()) ++chi[parts.find(quad[0])];
    std::vector<int> genera;
    genera.reserve(chi.size());
    for (const auto& [root, value] : chi) genera.push_back(1 - value / 2);
    return genera;
}

}  // namespace

LayoutVerdict judge_layout(const QuadLayout& layout, int chi,
                           const std::vector<std::vector<int>>& inside_cycles) {
    for (const auto& cycle : inside_cycles) check_cycle(layout, cycle);
    LayoutVerdict verdict;
    verdict.reason = fault_of_layout(layout, chi);
    verdict.is_quad_layout = verdict.reason.empty();
    if (!verdict.is_quad_layout) return verdict;
    verdict.reason = fault_of_configuration(layout, inside_cycles);
    verdict.is_cuboid_configuration = verdict.reason.empty();
    return verdict;
}

QuadLayout close_boundaries(const QuadLayout& layout, const std::vector<BoundaryCap>& caps) {
    const auto loops = boundary_loops(layout);
    QuadLayout closed = layout;
    for (const BoundaryCap& cap : caps) {
        if (cap.loop < 0 || cap.loop >= static_cast<int>(loops.size())) {
            throw InputError("a pattern is for boundary loop {} of the layout; it has {} of them",
                             cap.loop, loops.size());
        }
        closed = closed_by(closed, loops[cap.loop], cap);
    }
    return closed;
}

VolumeTopology volume_topology(const VolumetricLayout& layout) {
    const LayoutBoundary boundary = layout_boundary(layout);
    if (const auto node = find_pinched_node(boundary.layout)) {
        throw TopologyError("the boundary of the cuboids touches itself at node {}",
                            boundary.layout.node_name(*node));
    }
    const CellComplex volume = make_hexahedron_complex(layout.cuboids);
    check_volume_boundary(volume);
    VolumeTopology topology{volume.euler_characteristic(), betti_numbers(volume),
                            component_genera(boundary.layout)};
    const int n_shells = static_cast<int>(topology.genera.size());
    const int sum = std::reduce(topology.genera.begin(), topology.genera.end());
    const std::vector<int>& b = topology.betti;
    if (topology.chi != n_shells - sum || b[1] != sum || b[2] != n_shells - b[0]) {
        throw TopologyError(
            "the cuboids have chi = {} and Betti numbers {}; with {} boundary surfaces of genus {} "
            "in all, a volume in space has chi = {}, b_1 = {}, b_2 = {}",
            topology.chi, fmt::join(b, ", "), n_shells, sum, n_shells - sum, sum, n_shells - b[0]);
    }
    return topology;
}

}  // namespace couture::meshing
