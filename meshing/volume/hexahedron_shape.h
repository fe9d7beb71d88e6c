#pragma once

#include "iga/core/types.h"

namespace couture::meshing {

/// Corners of a hexahedron in columns, first direction fastest.
using Hexahedron = Matrix<3, 8>;

/// Shape ratio A / B: A the largest distance from the centroid to a corner, B the smallest distance
/// from the centroid to a face's plane, measured between the centroids along the face's normal
/// (that of its diagonals). sqrt(3) for a cube, infinite for a flat hexahedron.
///
/// Source: [Maquart19] Sec. 7.1.2.3.
[[nodiscard]] double shape_ratio(const Hexahedron& corners);

struct SmoothShapeRatio {
    double value = 0.0;
    Hexahedron gradient = Hexahedron::Zero();
};

/// A differentiable shape ratio over sqrt(3): 1 for a cube; power means instead of the largest and
/// the smallest, so it is below the exact ratio. Infinite where a face lies on the wrong side of
/// the centroid.
///
/// @param orientation  +1, or -1 for a left-handed hexahedron
[[nodiscard]] SmoothShapeRatio smooth_shape_ratio(const Hexahedron& corners, int orientation);

}  // namespace couture::meshing
