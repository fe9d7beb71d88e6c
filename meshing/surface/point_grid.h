#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "iga/core/types.h"

namespace couture::meshing {

/// Points in the cells of a grid, to find near ones in the time that those in a few cells take.
class PointGrid {
  public:
    /// @param cell  edge length of the grid's cells
    /// @throws InputError  unless it is positive and finite
    explicit PointGrid(double cell);

    void add(const Vector3& point);

    /// Distance from x to the nearest of the points, or the edge length of a cell if none is
    /// nearer.
    [[nodiscard]] double distance(const Vector3& x) const;

  private:
    using Cell = std::array<std::int64_t, 3>;

    [[nodiscard]] Cell cell_of(const Vector3& x) const;

    double cell_;
    /// By the hash of their cell; cells of one hash are looked at together.
    std::unordered_map<std::uint64_t, std::vector<Vector3>> cells_;
};

}  // namespace couture::meshing
