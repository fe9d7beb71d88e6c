#pragma once

#include "verification/verification.h"

namespace couture::verification {

/// Manufactured solutions on curved geometries: observed orders of convergence, p + 1 in L2 and p
/// in the H1 seminorm, p = 1..4, Poisson and elasticity (p = 1..3 neo-Hookean), one patch and
/// several.
[[nodiscard]] std::vector<Case> convergence_cases();

}  // namespace couture::verification
