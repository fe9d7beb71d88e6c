#include "rom/sample_grid.h"

#include "iga/core/error.h"

namespace couture::rom {

namespace {

std::vector<double> line_of(const iga::KnotVector& knots, int n_cells) {
    const std::vector<double>& breakpoints = knots.breakpoints();
    std::vector<double> parameters = {breakpoints[0]};
    for (std::size_t e = 0; e + 1 < breakpoints.size(); ++e) {
        const double length = breakpoints[e + 1] - breakpoints[e];
        for (int i = 1; i < n_cells; ++i) {
            parameters.push_back(breakpoints[e] + length * i / n_cells);
        }
        parameters.push_back(breakpoints[e + 1]);
    }
    return parameters;
}

/// Moves the ends of lines off what collapses.
void leave_collapsed(SampleGrid& grid, const iga::TensorSpace<3>& space,
                     const iga::CollapsedEntity<3>& collapsed) {
    constexpr double shift = 1e-6;
    for (int k = 0; k < 3; ++k) {
        const iga::End position = collapsed.entity.position[k];
        const iga::KnotVector& knots = space.knots[k];
        const std::vector<double>& ends = knots.breakpoints();
        if (position == iga::End::low && grid.parameters[k].front() == knots.front()) {
            grid.parameters[k].front() += shift * (ends[1] - ends[0]);
        } else if (position == iga::End::high && grid.parameters[k].back() == knots.back()) {
            grid.parameters[k].back() -= shift * (ends.back() - ends[ends.size() - 2]);
        }
    }
}

}  // namespace

std::array<int, 3> SampleGrid::sizes() const {
    return {static_cast<int>(parameters[0].size()), static_cast<int>(parameters[1].size()),
            static_cast<int>(parameters[2].size())};
}

int SampleGrid::n_points() const {
    const std::array<int, 3> n = sizes();
    return n[0] * n[1] * n[2];
}

Vector3 SampleGrid::point(int i_point) const {
    const std::array<int, 3> n = sizes();
    return {parameters[0][i_point % n[0]], parameters[1][i_point / n[0] % n[1]],
            parameters[2][i_point / n[0] / n[1]]};
}

std::vector<SampleGrid> make_sample_grids(const iga::Space<3>& space, SampleRegion region,
                                          int n_cells) {
    if (n_cells < 1) {
        throw InputError("make_sample_grids: {} cells per element; there must be at least 1",
                         n_cells);
    }
    std::vector<SampleGrid> grids;
    for (int p = 0; p < space.n_patches(); ++p) {
        SampleGrid grid{p, {}};
        for (int k = 0; k < 3; ++k) {
            grid.parameters[k] = line_of(space.tensor(p).knots[k], n_cells);
        }
        grids.push_back(std::move(grid));
    }
    if (region == SampleRegion::outer_sides) {
        std::vector<SampleGrid> sides;
        for (const iga::PatchEntity<3>& side : space.geometry().outer_sides()) {
            SampleGrid grid = grids[side.patch];
            std::vector<double>& line = grid.parameters[iga::side_direction(side.side())];
            line = {iga::side_is_high(side.side()) ? line.back() : line.front()};
            sides.push_back(std::move(grid));
        }
        grids = std::move(sides);
    }
    for (const iga::CollapsedEntity<3>& collapsed : iga::collapsed_entities(space.geometry())) {
        for (SampleGrid& grid : grids) {
            if (grid.patch == collapsed.entity.patch) {
                leave_collapsed(grid, space.tensor(grid.patch), collapsed);
            }
        }
    }
    return grids;
}

}  // namespace couture::rom
