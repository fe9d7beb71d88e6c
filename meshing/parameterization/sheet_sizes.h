#pragma once

#include <span>
#include <vector>

#include "meshing/layout/embedded_layout.h"

namespace couture::meshing {

struct SheetSizeOptions {
    /// Wanted length of a cell; 0: as few cells as min_cells allows.
    double target_size = 0.0;
    /// Of each sheet; at least 1.
    int min_cells = 1;
};

/// Length of each arc along its edges.
[[nodiscard]] std::vector<double> arc_lengths(const SurfaceMesh& mesh,
                                              const EmbeddedLayout& embedding);

/// Cells of each sheet (numbered by QuadLayout::sheets): the median of its arcs' lengths, weighted
/// by these lengths, over the target size, rounded, and no less than the minimum.
///
/// @throws InputError  for a negative target size or a minimum below 1
[[nodiscard]] std::vector<int> sheet_sizes(const SurfaceMesh& mesh, const EmbeddedLayout& embedding,
                                           const SheetSizeOptions& options);

/// Cells along each arc from those of the sheets: the same for all members of a family.
///
/// @throws InputError  unless there is a positive number for each sheet
[[nodiscard]] std::vector<int> cells_of_arcs(const QuadLayout& layout,
                                             std::span<const int> cells_of_sheets);

}  // namespace couture::meshing
