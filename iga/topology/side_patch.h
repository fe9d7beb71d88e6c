#pragma once

#include "iga/topology/multipatch.h"

namespace couture::iga {

/// The map of a side or edge with e free directions, in ascending order of the patch's directions.
template <int d, int e>
[[nodiscard]] Patch<e> entity_patch(const Patch<d>& patch, const std::array<End, d>& position);

/// The functions of the entity: knot vectors of its free directions.
template <int d, int e>
[[nodiscard]] TensorSpace<e> entity_space(const TensorSpace<d>& space,
                                          const std::array<End, d>& position);

/// Parameter of the patch at parameter xi of one of its entities.
template <int d, int e>
[[nodiscard]] Vector<d> entity_parameter(const TensorSpace<d>& space,
                                         const std::array<End, d>& position, const Vector<e>& xi);

/// +1, or -1 for a left-handed patch: the sign of det J at an interior point.
template <int d>
[[nodiscard]] int orientation(const Patch<d>& patch);

/// Sign that turns the cross product of a side's tangents (ascending directions; in the plane the
/// tangent turned clockwise) outwards, for a right-handed patch.
constexpr int outward_sign(int side) { return (side / 2 == 1 ? -1 : 1) * (side % 2 == 1 ? 1 : -1); }

}  // namespace couture::iga
