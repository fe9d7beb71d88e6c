#include "meshing/parameterization/layout_charts.h"

#include "iga/core/error.h"

namespace couture::meshing {

Vector2 turned(const Vector2& v, int quarter_turns) {
    switch (quarter_turns & 3) {
        case 1:
            return {-v.y(), v.x()};
        case 2:
            return {-v.x(), -v.y()};
        case 3:
            return {v.y(), -v.x()};
        default:
            return v;
    }
}

ChartTransition ChartTransition::inverse() const {
    return {(4 - quarter_turns) & 3, turned(-shift, -quarter_turns)};
}

ChartTransition ChartTransition::after(const ChartTransition& other) const {
    return {(quarter_turns + other.quarter_turns) & 3, turned(other.shift, quarter_turns) + shift};
}

LayoutCharts::LayoutCharts(const QuadLayout& layout, std::vector<int> cells)
    : cells_(std::move(cells)) {
    if (static_cast<int>(cells_.size()) != layout.n_arcs()) {
        throw InputError("LayoutCharts: {} numbers of cells for {} arcs; give one for each",
                         cells_.size(), layout.n_arcs());
    }
    for (int q = 0; q < layout.n_quads(); ++q) {
        std::array<int, 4> n{};
        for (int k = 0; k < 4; ++k) n[k] = cells_[layout.sides(q)[k].arc];
        if (n[0] != n[2] || n[1] != n[3] || n[0] < 1 || n[1] < 1) {
            const auto& sides = layout.sides(q);
            std::string found;
            for (int k = 0; k < 4; ++k) {
                found += fmt::format("{}{} on the arc of nodes {}", k == 0 ? "" : ", ", n[k],
                                     layout.arc_name(sides[k].arc));
            }
            throw InputError(
                "LayoutCharts: the sides of quad {} have these cells: {}; arcs that face each "
                "other "
                "must have the same positive number",
                q, found);
        }
        sizes_.push_back({n[0], n[1]});
    }
    for (int a = 0; a < layout.n_arcs(); ++a) {
        const auto& [left, right] = layout.arc_quads(a);
        ChartTransition transition;
        if (!layout.is_boundary_arc(a)) {
            transition.quarter_turns = (right.side + 2 - left.side) & 3;
            transition.shift = corner(right.quad, right.side + 1) -
                               turned(corner(left.quad, left.side), transition.quarter_turns);
        }
        across_.push_back(transition);
    }
}

Vector2 LayoutCharts::corner(int quad, int corner) const {
    const int k = corner & 3;
    return {k == 1 || k == 2 ? sizes_[quad][0] : 0.0, k >= 2 ? sizes_[quad][1] : 0.0};
}

}  // namespace couture::meshing
