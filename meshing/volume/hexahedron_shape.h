#pragma once

#include "iga/topology/cell_shape.h"

namespace couture::meshing {

/// Corners of a hexahedron in columns, first direction fastest.
using Hexahedron = iga::CellCorners<3>;

struct SmoothShapeRatio {
    double value = 0.0;
    Hexahedron gradient = Hexahedron::Zero();
};

/// A differentiable shape ratio (see iga::shape_ratio) over sqrt(3): 1 for a cube; power means
/// instead of the largest and the smallest, so it is below the exact ratio. Infinite where a face
/// lies on the wrong side of the centroid.
///
/// @param orientation  +1, or -1 for a left-handed hexahedron
[[nodiscard]] SmoothShapeRatio smooth_shape_ratio(const Hexahedron& corners, int orientation);

}  // namespace couture::meshing
