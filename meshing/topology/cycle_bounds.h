#pragma once

#include <vector>

#include "meshing/surface/cut_surface.h"

namespace couture::meshing {

/// Lower bounds on the lengths of closed curves on a piece of genus 0 that part two boundary loops
/// from the others, in next to no time.
///
/// Such a curve crosses every path from one of the two to a third loop. If it crosses one from loop
/// i at x and one from loop j at y, it is at least 2 |x - y| long: twice the distance between the
/// two paths. Taken are paths to the nearest loops; the bound is on straight distances and holds
/// however the piece is refined, and after parts of it on the other side of the curve are gone.
class CycleBounds {
  public:
    /// @param piece  connected, genus 0, without chords (CutSurface::split_chords)
    /// @param loops  its boundary loops, see CutSurface::boundary_loops; at least three
    CycleBounds(const CutSurface& piece, const std::vector<std::vector<int>>& loops);

    /// No closed curve that parts loops i and j from all others is shorter.
    [[nodiscard]] double length_around(int i, int j) const;

  private:
    using Boxes = std::vector<Eigen::AlignedBox<double, 3>>;

    /// A path to another loop, as boxes around its edges or a few of them.
    struct Way {
        int loop = -1;
        Boxes boxes;
    };

    /// For each loop to those that are nearest.
    std::vector<std::vector<Way>> ways_;
};

}  // namespace couture::meshing
