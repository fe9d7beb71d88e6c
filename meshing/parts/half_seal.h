#pragma once

#include "meshing/parts/part_definition.h"

namespace couture::meshing {

/// `half_seal`: the x >= 0 half of a ring about the z axis with one arm along x, exact NURBS.
///
/// The ring is cut where the arm's faces meet it: at the angles +-asin(arm_half_width /
/// outer_radius), radially through the wall, and at z = +-arm_height / 2. 3 x 3 cuboids (radius,
/// angle, z), numbered with the angle fastest, and the arm (x, y, z) as the last: 13 interfaces, 34
/// outer sides. Lines of the arm along its length are parallel to x. `divisions` = k cuts the
/// cuboids into 128 k^3 elements of about 7 / k mm (ring: 2 k in radius, 5 k, 3 k, 5 k in angle, k,
/// 2 k, k in z; arm: 4 k, 3 k, 2 k).
[[nodiscard]] std::vector<PartDefinition> half_seal_parts();

}  // namespace couture::meshing
