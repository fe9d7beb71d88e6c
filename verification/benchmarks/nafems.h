#pragma once

#include "verification/verification.h"

namespace couture::verification {

/// Elliptic membrane LE1 and thick plate LE10. Source: [NAFEMS90].
[[nodiscard]] std::vector<Case> nafems_cases();

}  // namespace couture::verification
