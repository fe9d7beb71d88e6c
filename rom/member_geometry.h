#pragma once

#include "iga/topology/space.h"

namespace couture::rom {

/// The control points of a member's geometry as a field on the reference member's functions.
///
/// @param reference  the functions of the reference member's own geometry
/// @return 3 n_dofs numbers, 3 node + component
/// @throws InputError  if the member has another signature or other weights, or if the reference's
///                     space is not its geometry's own: says which
[[nodiscard]] VectorX to_field(const iga::Space<3>& reference, const iga::MultiPatch<3>& member);

/// The member with these control points: the reference with others.
///
/// @param control_points  3 n_dofs numbers
[[nodiscard]] iga::MultiPatch<3> to_member(const iga::Space<3>& reference,
                                           const VectorX& control_points);

}  // namespace couture::rom
