#pragma once

#include "iga/spline/patch.h"
#include "iga/topology/patch_sides.h"

namespace couture::iga {

/// How far two sides are from being one.
struct SideGap {
    /// Largest distance between control points that should coincide.
    double distance = 0.0;
    /// Largest relative difference of weights after scaling to a common factor.
    double weight = 0.0;
};

/// Compares the control nets of the two sides in the orientation of the interface; where knots or
/// degrees differ, on their smallest common refinement. The patch numbers of `interface` are not
/// read.
template <int d>
[[nodiscard]] SideGap side_gap(const Patch<d>& first, const Patch<d>& second,
                               const Interface<d>& interface);

}  // namespace couture::iga
