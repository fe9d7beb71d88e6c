#pragma once

#include "verification/verification.h"

namespace couture::verification {

/// Shells as solids of one element through the thickness: Scordelis-Lo roof and pinched cylinder.
/// Source: [ScordelisLo64], [MacNealHarder85].
[[nodiscard]] std::vector<Case> shell_cases();

}  // namespace couture::verification
