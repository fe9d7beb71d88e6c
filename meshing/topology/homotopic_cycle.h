#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "meshing/surface/cut_surface.h"

namespace couture::meshing {

/// A simple closed path on a piece that, with boundary loops i and j, bounds a pant.
struct HomotopicCycle {
    /// The piece, cut open to find the cycle, some edges split to let it pass.
    CutSurface surface;
    /// Original vertices of `surface` (CutSurface::original) in order, with loops i and j on the
    /// left; the first one does not stand again at the end.
    std::vector<int> vertices;
    /// Path from loop i to loop j around which the cycle runs; vertices of the piece that was
    /// given.
    std::vector<int> path;
    /// Length times factors.
    double weight = 0.0;
};

/// Cycles around two boundary loops of a piece of genus 0 at a time: w_ij homotopic to w_i p w_j
/// p^-1, p the shortest path from loop i to loop j.
///
/// The piece is cut along p and along shortest paths that join the other loops; what is left is a
/// cylinder, on which the shortest closed path around is found by halving: one from the middle of a
/// shortest path between the ends divides the cylinder in two. O(n log^2 n) each. The cycle touches
/// no boundary of the piece.
///
/// Source: [Maquart19] Alg. 3.2, 3.3; [Reif83] for the halving. Differs: the text takes all paths
/// between opposite points one by one.
class HomotopicCycles {
  public:
    /// @param piece   connected, genus 0, without chords (CutSurface::split_chords), at least three
    ///                boundary loops
    /// @param factor  for each vertex a positive factor on lengths; empty: 1
    /// @param points  vertices that cycles pass (Alg. 3.3), see find_cycle_through
    /// @throws TopologyError  if the piece is of another kind
    /// @throws InputError     if one of the points lies on its boundary
    explicit HomotopicCycles(const CutSurface& piece, std::vector<double> factor = {},
                             std::vector<int> points = {});

    /// Boundary loops, see CutSurface::boundary_loops.
    [[nodiscard]] const std::vector<std::vector<int>>& loops() const { return loops_; }

    /// The cycle around loops i and j.
    ///
    /// @throws InputError     if i = j or one does not exist
    /// @throws TopologyError  if there is none
    [[nodiscard]] HomotopicCycle find(int i, int j) const;

  private:
    /// Where the cycle may run: on the cuts that make the cylinder; between them, chords split; or
    /// with a ring of vertices put around them, for the narrowest places.
    enum class Room { at_cuts, beside_cuts, made };

    /// Halfedges of the shortest path from loop i to loop j.
    ///
    /// @throws TopologyError  if the points are in the way
    [[nodiscard]] std::vector<int> path_between(int i, int j) const;
    [[nodiscard]] std::optional<HomotopicCycle> find_on(const std::vector<int>& path, int i, int j,
                                                        Room room) const;

    const CutSurface* piece_;
    std::vector<double> factor_;
    std::vector<int> points_;
    std::vector<std::vector<int>> loops_;
    /// Loop of each boundary vertex of the piece, or -1.
    std::vector<int> loop_of_vertex_;
};

}  // namespace couture::meshing
