#pragma once

#include "iga/spline/knot_vector.h"

namespace couture::iga {

/// `knots` with each interior breakpoint that lies within `tolerance` of the interval of one of
/// `target` moved onto it. Both span the same interval. What KnotVector::conforms_to takes for
/// equal thus makes no sliver in a common refinement.
[[nodiscard]] KnotVector snap_knots(const KnotVector& knots, const KnotVector& target,
                                    double tolerance = 1e-10);

}  // namespace couture::iga
