#pragma once

#include <functional>
#include <limits>
#include <map>
#include <vector>

#include "meshing/layout/embed_layout.h"
#include "meshing/layout/quad_layout.h"

namespace couture::meshing {

/// Arcs of a closed layout that are drawn on a surface one by one, and the cheapest ways for
/// others between them. Edges of drawn arcs get their number as curve.
class ArcPaths {
  public:
    struct Path {
        std::vector<VertexHandle> vertices;
        double length = std::numeric_limits<double>::infinity();
    };
    using EdgeTest = std::function<bool(HalfedgeHandle)>;
    using EdgeCost = std::function<double(HalfedgeHandle)>;
    using EndCost = std::function<double(VertexHandle)>;

    /// Nothing is drawn. Both must outlive it.
    ArcPaths(SurfaceMesh& mesh, const QuadLayout& layout);

    void place(int node, VertexHandle vertex);
    /// Invalid for nodes without a place.
    [[nodiscard]] VertexHandle vertex(int node) const { return node_vertex_[node]; }
    [[nodiscard]] bool is_placed(int node) const { return node_vertex_[node].is_valid(); }
    [[nodiscard]] bool has_node(VertexHandle vertex) const {
        return node_of_vertex_[vertex.idx()] >= 0;
    }
    /// For each arc.
    [[nodiscard]] const std::vector<bool>& is_drawn() const { return is_drawn_; }

    /// The cheapest way for an arc that starts at one of its nodes, over vertices of no other arc,
    /// between the drawn arcs that are beside it in the layout.
    ///
    /// @param end       its last vertex; invalid: the reached free vertex of least `end_cost`
    /// @return no vertices and infinite length if there is none
    [[nodiscard]] Path find(int arc, int node, VertexHandle end, const EdgeTest& may_take,
                            const EdgeCost& cost, const EndCost& end_cost = {}) const;
    /// Draws an arc along edges from the first node to the second one.
    void draw(int from, int to, std::vector<VertexHandle> path, bool is_feature);
    /// Draws the arcs of a tie, whose nodes have places.
    void draw(const LayoutTie& tie);
    /// Splits edges between drawn arcs that are not on them, so that ways exist.
    void split_chords();

    /// One for each drawn arc, in the order of drawing.
    [[nodiscard]] std::vector<LayoutTie> take_ties() { return std::move(ties_); }

  private:
    [[nodiscard]] bool is_free(VertexHandle vertex) const;
    [[nodiscard]] HalfedgeHandle start_of(int arc, int node) const;
    [[nodiscard]] std::vector<int> fan_from(int arc, int node) const;
    [[nodiscard]] bool is_in_sector(int arc, int node, HalfedgeHandle h) const;

    SurfaceMesh& mesh_;
    const QuadLayout& layout_;
    std::vector<VertexHandle> node_vertex_;
    std::vector<int> node_of_vertex_;
    std::vector<bool> is_drawn_;
    std::map<int, std::vector<VertexHandle>> paths_;
    std::vector<LayoutTie> ties_;
};

/// Length of an edge, the more of it the farther from a straight line it is.
[[nodiscard]] ArcPaths::EdgeCost cost_near_line(const SurfaceMesh& mesh, const Vector3& start,
                                                const Vector3& end);

/// Sum of the unit normals of the quads around each node.
[[nodiscard]] std::vector<Vector3> node_normals(const QuadLayout& layout,
                                                const std::vector<Vector3>& positions);

/// Unit normal of a quad of the layout, of its diagonals.
[[nodiscard]] Vector3 quad_normal(const std::array<int, 4>& quad,
                                  const std::vector<Vector3>& positions);

}  // namespace couture::meshing
