#pragma once

#include <memory>
#include <span>
#include <vector>

#include "iga/core/types.h"
#include "meshing/layout/quad_layout.h"

namespace couture::meshing {

/// Quads that hang together through arcs that are not drawn yet, cut open along those that are: a
/// node has one place for each fan of quads.
class LayoutRegion {
  public:
    /// A side of a quad.
    struct Place {
        int quad;
        int side;
    };
    /// Places of nodes, by their numbers in the region; from each to the next there is an arc.
    using Path = std::vector<int>;

    /// @param layout    must outlive the region
    /// @param is_drawn  for each arc
    LayoutRegion(const QuadLayout& layout, std::vector<int> quads,
                 const std::vector<bool>& is_drawn);

    [[nodiscard]] const std::vector<int>& quads() const { return quads_; }
    /// Boundary loops as sides in order, the region on their left. All drawn arcs of the region,
    /// those inside it twice.
    [[nodiscard]] const std::vector<std::vector<Place>>& loops() const { return loops_; }
    [[nodiscard]] int euler_characteristic() const;
    /// Number of the node at a place.
    [[nodiscard]] int node(int place) const { return node_[place]; }
    /// The side of the boundary that starts at a place.
    [[nodiscard]] Place place_of(int place) const;
    /// Of a disc: where on its loop a place of the boundary comes.
    [[nodiscard]] int index_on_loop(int place) const { return index_on_loop_[place]; }

    /// The paths of fewest arcs from one boundary loop to another.
    [[nodiscard]] std::vector<Path> paths_between_loops() const;
    /// Of a disc of several quads: a path inside it from boundary to boundary, of fewest arcs, that
    /// divides it best.
    [[nodiscard]] Path dividing_path() const;
    /// Of a disc: a point for each place, those of the boundary at the corners of a convex polygon
    /// in the order of the loop, the others in the middle of their neighbours.
    ///
    /// Source: [Tutte63].
    [[nodiscard]] std::vector<Vector2> tutte_embedding(std::span<const Vector2> polygon) const;

    /// What is left of the region after more arcs were drawn.
    [[nodiscard]] std::vector<LayoutRegion> parts(const std::vector<bool>& is_drawn) const;

  private:
    void number_places(const std::vector<bool>& is_drawn);
    void find_loops(const std::vector<bool>& is_drawn);
    [[nodiscard]] std::vector<Path> paths_from(int start, const std::vector<char>& is_end) const;
    [[nodiscard]] int quads_left_of(const Path& path) const;

    const QuadLayout* layout_;
    std::vector<int> quads_;
    // Place of each corner of each quad, in the order of quads_.
    std::vector<std::array<int, 4>> places_;
    std::vector<int> node_;
    // Places that arcs not drawn join.
    std::vector<std::vector<int>> inner_neighbours_;
    std::vector<std::vector<Place>> loops_;
    // The loop of each place of the boundary and where it comes there; -1 inside.
    std::vector<int> loop_of_;
    std::vector<int> index_on_loop_;
    int n_arcs_ = 0;
};

/// The regions of a layout between arcs that are drawn, in the order of their smallest quad.
[[nodiscard]] std::vector<LayoutRegion> layout_regions(const QuadLayout& layout,
                                                       const std::vector<bool>& is_drawn);

}  // namespace couture::meshing
