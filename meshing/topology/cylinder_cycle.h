#pragma once

#include <optional>
#include <span>
#include <vector>

#include "meshing/surface/cut_surface.h"
#include "meshing/surface/shortest_paths.h"

namespace couture::meshing {

/// A surface that is being cut, with factors on lengths for the vertices that come by splits and
/// slices.
struct Cutting {
    CutSurface surface;
    /// For each vertex; empty: 1.
    std::vector<double> factor;

    void slice(const std::vector<int>& path);
    void split_chords();
    /// Chords, and edges that join two of some vertices, or one of them and the boundary: whatever
    /// is not blocked by these vertices and the boundary can be reached around them.
    void split_chords(std::span<const int> points);
    /// Splits the edges that end on the boundary: a ring of vertices around it.
    void split_spokes();
    [[nodiscard]] ShortestPaths paths() const {
        return ShortestPaths(surface, factor.empty() ? nullptr : &factor);
    }

  private:
    void extend_factors();
};

[[nodiscard]] std::vector<char> boundary_vertices(const CutSurface& surface);

/// A closed path around a cylinder.
struct CylinderCycle {
    /// In order, by their numbers before the cylinder was opened (CutSurface::original); with the
    /// inner end on the left.
    std::vector<int> vertices;
    /// Length times factors.
    double weight = 0.0;
};

/// The shortest closed path around a cylinder, by halving: the shortest one through the middle of a
/// path between the ends divides the cylinder in two. O(n log^2 n).
///
/// @param cylinder    is opened along the way
/// @param inner       one of its boundary loops, as halfedges
/// @param outer       the other one
/// @param is_blocked  for each vertex whether the cycle must not pass it
/// @return nothing if there is no such path
///
/// Source: [Reif83].
[[nodiscard]] std::optional<CylinderCycle> find_cycle_around(Cutting& cylinder,
                                                             const std::vector<int>& inner,
                                                             const std::vector<int>& outer,
                                                             std::vector<char> is_blocked);

/// A short closed path around a cylinder through given vertices inside, from one to the next by
/// shortest paths: in the order in which they lie around it by a harmonic map to a rectangle, or to
/// the nearest one each time, whichever is shorter. The map alone may have them in a bad order
/// where the cylinder winds.
///
/// @param cylinder  is opened along the way
/// @param points    at least one vertex, none of them on the boundary
/// @return nothing if there is no such path
///
/// Source: [Maquart19] Alg. 3.3. Differs: the text takes straight lines of the map.
[[nodiscard]] std::optional<CylinderCycle> find_cycle_through(Cutting& cylinder,
                                                              const std::vector<int>& inner,
                                                              const std::vector<int>& outer,
                                                              const std::vector<int>& points);

}  // namespace couture::meshing
