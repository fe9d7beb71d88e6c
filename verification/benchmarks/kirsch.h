#pragma once

#include "verification/verification.h"

namespace couture::verification {

/// Infinite plate with a circular hole under tension. Source: [Kirsch1898].
[[nodiscard]] std::vector<Case> kirsch_cases();

}  // namespace couture::verification
