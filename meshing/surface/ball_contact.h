#pragma once

#include <array>
#include <optional>

#include "iga/core/types.h"

namespace couture::meshing {

/// How far the centre of a ball moves along a line until the ball touches a triangle; 0 if it does
/// so from the start. A ball of radius 0 meets triangles with area only, their edges included.
///
/// @param direction  of length 1
/// @return nothing if it never does
///
/// Source: [Ericson05] 5.5.6 (its 5.5.7 is an approximation); [MollerTrumbore97].
[[nodiscard]] std::optional<double> ball_contact(const Vector3& start, const Vector3& direction,
                                                 double radius,
                                                 const std::array<Vector3, 3>& triangle);

}  // namespace couture::meshing
