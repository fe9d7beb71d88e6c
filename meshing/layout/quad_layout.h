#pragma once

#include <array>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace couture::meshing {

/// A coarse quad mesh on a surface, combinatorics only: nodes, arcs between them, quads. Two nodes
/// have at most one arc between them.
///
/// Source: [Maquart19] Def. 6.4.
class QuadLayout {
  public:
    struct Arc {
        /// The smaller node first.
        int from;
        int to;
        bool operator==(const Arc&) const = default;
    };
    /// Side k of a quad runs from its corner k to corner k + 1.
    struct Side {
        int arc;
        /// Whether it runs from the arc's first node to its second.
        bool is_forward;
        bool operator==(const Side&) const = default;
    };

    QuadLayout() = default;
    /// @param quads  corners counter-clockwise seen from outside; any node numbers below n_nodes
    /// @throws InputError     for a node out of range or one that stands twice in a quad
    /// @throws TopologyError  for an arc with more than two quads, or two that run along it in the
    ///                        same direction; names the quad and the nodes
    /// @param node_names  that messages call nodes by: of the first ones, empty for none
    QuadLayout(int n_nodes, std::vector<std::array<int, 4>> quads,
               std::vector<std::string> node_names = {});

    [[nodiscard]] int n_nodes() const { return n_nodes_; }
    /// What messages call a node: its name in quotes, or its number.
    [[nodiscard]] std::string node_name(int node) const;
    /// Names of the nodes at the ends of an arc: "a and b".
    [[nodiscard]] std::string arc_name(int arc) const;
    /// Names of the nodes of a quad: "a, b, c, d".
    [[nodiscard]] std::string quad_name(int quad) const;
    [[nodiscard]] int n_arcs() const { return static_cast<int>(arcs_.size()); }
    [[nodiscard]] int n_quads() const { return static_cast<int>(quads_.size()); }
    [[nodiscard]] const std::vector<std::array<int, 4>>& quads() const { return quads_; }
    /// Numbered by their nodes: ascending pairs (from, to).
    [[nodiscard]] const std::vector<Arc>& arcs() const { return arcs_; }
    [[nodiscard]] const std::array<Side, 4>& sides(int quad) const { return sides_[quad]; }
    /// -1 if there is none.
    [[nodiscard]] int find_arc(int from, int to) const;

    /// A quad and its side along an arc; quad -1 on the boundary.
    struct ArcQuad {
        int quad = -1;
        int side = -1;
    };
    /// The quads on the left (where its side runs forwards) and on the right of an arc.
    [[nodiscard]] const std::array<ArcQuad, 2>& arc_quads(int arc) const { return arc_quads_[arc]; }
    [[nodiscard]] bool is_boundary_arc(int arc) const {
        return arc_quads_[arc][0].quad < 0 || arc_quads_[arc][1].quad < 0;
    }
    /// Number of arcs at each node.
    [[nodiscard]] std::vector<int> valences() const;
    /// Nodes that have arcs, less arcs, plus quads.
    [[nodiscard]] int euler_characteristic() const;
    /// For each node whether an arc of the boundary ends there.
    [[nodiscard]] std::vector<bool> boundary_nodes() const;
    /// For each arc the number of its sheet: arcs that face each other in a quad belong to the same
    /// one and have the same number of elements. Counted in the order of their smallest arc.
    [[nodiscard]] std::vector<int> sheets() const;

  private:
    int n_nodes_ = 0;
    std::vector<std::array<int, 4>> quads_;
    std::vector<std::string> node_names_;
    std::vector<Arc> arcs_;
    std::vector<std::array<Side, 4>> sides_;
    std::vector<std::array<ArcQuad, 2>> arc_quads_;
    std::map<std::pair<int, int>, int> arc_of_nodes_;
};

/// What messages call a node: its name in quotes if there is one, else its number.
[[nodiscard]] std::string node_name(const std::vector<std::string>& names, int node);

/// Nodes along each boundary loop, the quads on the left; the smallest node of each first, loops in
/// the order of these.
///
/// @throws TopologyError  if the boundary touches itself at a node; names it
[[nodiscard]] std::vector<std::vector<int>> boundary_loops(const QuadLayout& layout);

}  // namespace couture::meshing
