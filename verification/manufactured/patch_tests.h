#pragma once

#include "verification/verification.h"

namespace couture::verification {

/// What the discrete space contains must come out exactly: polynomials on multilinear maps, linear
/// fields on curved ones, rigid motions without energy.
[[nodiscard]] std::vector<Case> patch_test_cases();

}  // namespace couture::verification
