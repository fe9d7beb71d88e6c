#pragma once

#include <vector>

#include "iga/core/types.h"
#include "meshing/layout/quad_layout.h"

namespace couture::meshing {

/// Points on a surface in the structure of a layout: a quad mesh of a grid per quad, whose borders
/// are shared. Quad q has n_s x n_t cells, n_s on its sides 0 and 2, n_t on its sides 1 and 3; all
/// arcs of a sheet have the same number.
struct LayoutSamples {
    QuadLayout layout;
    /// Cells along each arc; at least 1.
    std::vector<int> n_cells;
    /// For each arc its n_cells + 1 points from its first node to its second, in columns.
    std::vector<MatrixX> arcs;
    /// For each quad (n_s + 1) (n_t + 1) points in columns, s fastest: s runs along side 0 from
    /// corner 0 to corner 1, t along side 1 from corner 1 to corner 2. Border points equal those of
    /// the arcs exactly.
    std::vector<MatrixX> quads;
    /// For each arc whether it runs along a feature curve.
    std::vector<bool> is_feature_arc;
};

}  // namespace couture::meshing
