#pragma once

#include <vector>

#include "meshing/layout/embedded_layout.h"
#include "meshing/layout/layout_samples.h"
#include "meshing/surface/quad_grid.h"

namespace couture::meshing {

/// Numbers of the points of a layout's grids, borders shared: first nodes, then the insides of
/// arcs, then those of quads, each in order.
struct SampleGrid {
    int n_points = 0;
    /// For each arc n_cells + 1 numbers from its first node to its second.
    std::vector<std::vector<int>> arcs;
    /// For each quad (n_s + 1) (n_t + 1) numbers, s fastest.
    std::vector<std::vector<int>> quads;
    /// For each quad n_s and n_t.
    std::vector<std::array<int, 2>> sizes;
};

/// @param cells  along each arc
/// @throws InputError  as LayoutCharts
[[nodiscard]] SampleGrid make_sample_grid(const QuadLayout& layout, const std::vector<int>& cells);

/// Points by their numbers, in columns.
[[nodiscard]] MatrixX to_points(const LayoutSamples& samples, const SampleGrid& grid);

/// @param points  by their numbers, in columns
[[nodiscard]] LayoutSamples to_samples(const EmbeddedLayout& embedding, std::vector<int> cells,
                                       const SampleGrid& grid, const MatrixX& points);

/// The cells of all quads; points by their numbers in make_sample_grid.
[[nodiscard]] QuadMesh to_quad_mesh(const LayoutSamples& samples);

}  // namespace couture::meshing
