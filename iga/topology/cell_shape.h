#pragma once

#include "iga/core/types.h"

namespace couture::iga {

/// Corners of a hexahedron or quadrilateral as columns, direction 0 fastest: column
/// i_0 + 2 i_1 + 4 i_2 with i_k = 0 or 1.
template <int d>
using CellCorners = Matrix<d, (1 << d)>;

/// Shape ratio S_r = A / B: A is the largest distance of a corner from the mean of the corners, B
/// the smallest distance of that mean from a face's plane. Faces need not be plane: theirs runs
/// through the mean of the face's corners, across the cross product of its diagonals. Edges take
/// the place of faces in a quadrilateral.
///
/// @return sqrt(d) for cubes and squares, more for all else, also for boxes; infinity where B = 0
///         or a face has no area. Folded cells may have small ratios.
///
/// Source: [Maquart19] Sec. 7.1.2.3.
[[nodiscard]] double shape_ratio(const CellCorners<3>& corners);
[[nodiscard]] double shape_ratio(const CellCorners<2>& corners);

/// Sum over the corners of |3 pi / 2 - sum of the three angles between their edges|; in a
/// quadrilateral of |pi / 2 - angle|. An angle with an edge of no length counts as pi / 2: a box
/// keeps 0 however flat.
///
/// @return 0 for boxes; up to 6 pi, reached on a line (2 pi in the plane); 4 pi for a hexahedron
///         pressed flat with one face inside the opposite one
///
/// Source: [Maquart19] Eq. (C.7).
[[nodiscard]] double angle_deviation(const CellCorners<3>& corners);
[[nodiscard]] double angle_deviation(const CellCorners<2>& corners);

}  // namespace couture::iga
