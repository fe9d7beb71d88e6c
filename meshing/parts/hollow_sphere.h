#pragma once

#include "meshing/parts/part_definition.h"

namespace couture::meshing {

/// `hollow_sphere`: the first octant of a spherical shell as three exact patches of degree (1, 4,
/// 4) that meet on the diagonal (1, 1, 1); no collapsed edges.
///
/// One third of the octant is mapped by stereographic projection from -e_x onto a region bounded by
/// two lines and two circular arcs; its biquadratic rational Coons patch (U, V, W) is lifted by
/// (x, y, z, w) = (W^2 - U^2 - V^2, 2 U W, 2 V W, W^2 + U^2 + V^2), which lies on the unit sphere
/// identically. The other two thirds are cyclic permutations of the axes. Source: [Cobb88].
[[nodiscard]] std::vector<PartDefinition> hollow_sphere_parts();

}  // namespace couture::meshing
