#pragma once

#include <array>
#include <vector>

#include "iga/core/types.h"
#include "meshing/layout/quad_layout.h"

namespace couture::meshing {

/// A vector turned counter-clockwise by quarter turns, exactly.
[[nodiscard]] Vector2 turned(const Vector2& v, int quarter_turns);

/// Change of charts: y = R^quarter_turns x + shift, R a quarter turn counter-clockwise; shifts are
/// whole numbers.
///
/// Source: [Maquart19] Eq. (4.15).
struct ChartTransition {
    /// 0 to 3.
    int quarter_turns = 0;
    Vector2 shift = Vector2::Zero();

    [[nodiscard]] Vector2 operator()(const Vector2& x) const {
        return turned(x, quarter_turns) + shift;
    }
    [[nodiscard]] ChartTransition inverse() const;
    /// First `other`, then this one.
    [[nodiscard]] ChartTransition after(const ChartTransition& other) const;
    bool operator==(const ChartTransition&) const = default;
};

/// The charts of a layout: quad q is the rectangle [0, n_s] x [0, n_t], its corner 0 at the origin
/// and side 0 along the first axis.
class LayoutCharts {
  public:
    /// @param cells  along each arc
    /// @throws InputError  unless there is a positive number for each arc, and the same one for
    ///                     arcs that face each other; names the quad and its arcs
    LayoutCharts(const QuadLayout& layout, std::vector<int> cells);

    [[nodiscard]] const std::vector<int>& cells() const { return cells_; }
    /// n_s and n_t.
    [[nodiscard]] const std::array<int, 2>& size(int quad) const { return sizes_[quad]; }
    /// Any number of `corner` counts round the quad.
    [[nodiscard]] Vector2 corner(int quad, int corner) const;
    /// From the quad on the left of an arc to that on its right.
    [[nodiscard]] const ChartTransition& across(int arc) const { return across_[arc]; }

  private:
    std::vector<int> cells_;
    std::vector<std::array<int, 2>> sizes_;
    std::vector<ChartTransition> across_;
};

}  // namespace couture::meshing
