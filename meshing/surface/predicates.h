#pragma once

#include "iga/core/types.h"

namespace couture::meshing {

/// On which side of the line from a to b the point c lies: 1 left, 0 on it, -1 right. Exact for
/// the coordinates as they are stored; coordinates must be finite.
[[nodiscard]] int orientation(const Vector2& a, const Vector2& b, const Vector2& c);

/// Sign of det(b - a, c - a, d - a): 1 if a, b, c turn clockwise as seen from d, 0 if all lie in a
/// plane. Exact for the coordinates as they are stored; coordinates must be finite.
[[nodiscard]] int orientation(const Vector3& a, const Vector3& b, const Vector3& c,
                              const Vector3& d);

}  // namespace couture::meshing
