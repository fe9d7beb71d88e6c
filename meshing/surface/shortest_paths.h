#pragma once

#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "meshing/surface/cut_surface.h"

namespace couture::meshing {

/// Shortest edge paths of a piece by Dijkstra's algorithm. One object serves any number of
/// searches; each costs what it touches. Among equal distances the smaller vertex number is settled
/// first, so that the same input gives the same paths.
///
/// Edges along the boundary are part of a path only if the search says so.
///
/// Source: [Dijkstra59].
class ShortestPaths {
  public:
    /// Where a search starts and what it may pass. Vertices that are no key of a vector stand for
    /// "no".
    struct Search {
        std::span<const int> sources;
        /// For each vertex: a path may end there but not go on. Sources are exempt.
        const std::vector<char>* is_blocked = nullptr;
        /// The search ends at the first of them that is settled.
        const std::vector<char>* is_target = nullptr;
        /// Vertices farther away are not settled.
        double limit = std::numeric_limits<double>::infinity();
        /// Whether paths may run along the boundary.
        bool takes_boundary_edges = false;
    };

    /// @param factor  for each vertex a positive factor on lengths, taken as the mean over an edge;
    ///                empty: 1
    explicit ShortestPaths(const CutSurface& surface, const std::vector<double>* factor = nullptr)
        : surface_(&surface), factor_(factor) {}

    /// Copies the edges to where searches find them faster: worth it for three or more on a surface
    /// that does not change any more.
    void prepare();

    /// Runs the search and forgets the one before it.
    ///
    /// @return the target that was settled, or -1
    int run(const Search& search);

    /// Length of the shortest path to a vertex that was settled; infinite for any other.
    [[nodiscard]] double distance(int v) const {
        return v < static_cast<int>(state_.size()) && state_[v].is_settled
                   ? state_[v].distance
                   : std::numeric_limits<double>::infinity();
    }
    /// Last halfedge of the path to v; -1 at a source and for what was not settled. Not for
    /// searches that take boundary edges.
    [[nodiscard]] int arrival(int v) const { return state_[v].arrival; }
    /// Settled vertices by distance.
    [[nodiscard]] const std::vector<int>& settled() const { return settled_; }
    /// Halfedges from a source to v, those along the boundary left out.
    [[nodiscard]] std::vector<int> path_to(int v) const;
    /// Vertices from a source to v, both included.
    [[nodiscard]] std::vector<int> vertices_to(int v) const;
    /// Length of a halfedge with its factor.
    [[nodiscard]] double weight(int h) const;

  private:
    struct State {
        double distance = std::numeric_limits<double>::infinity();
        // -2 - h: along boundary halfedge h, from its target to its origin.
        int arrival = -1;
        bool is_settled = false;
    };

    [[nodiscard]] int before(int arrival) const {
        return arrival >= 0 ? surface_->origin(arrival) : surface_->target(-2 - arrival);
    }

    // An edge that leaves a vertex, as run() follows it.
    struct Step {
        double weight;
        int target;
        // As State::arrival.
        int arrival;
    };
    // Calls a function with each of the steps from v.
    template <typename Function>
    void for_each_step(int v, bool takes_boundary_edges, const Function& function) const;

    const CutSurface* surface_;
    const std::vector<double>* factor_;
    // If prepared: those of vertex v are steps_[first_step_[v]] up to that of v + 1.
    std::vector<Step> steps_;
    std::vector<int> first_step_;
    std::vector<State> state_;
    std::vector<int> touched_;
    std::vector<int> settled_;
    std::vector<std::pair<double, int>> heap_;
};

}  // namespace couture::meshing
