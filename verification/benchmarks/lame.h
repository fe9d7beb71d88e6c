#pragma once

#include "verification/verification.h"

namespace couture::verification {

/// Thick cylinder and hollow sphere under internal pressure. Source: [Lame1852].
[[nodiscard]] std::vector<Case> lame_cases();

}  // namespace couture::verification
