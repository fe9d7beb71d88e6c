#pragma once

#include "verification/verification.h"

namespace couture::verification {

/// Cook's membrane, compressible in plane stress and nearly incompressible in plane strain. Source:
/// [Cook74] for the problem; the expected values are converged ones.
[[nodiscard]] std::vector<Case> cook_cases();

}  // namespace couture::verification
