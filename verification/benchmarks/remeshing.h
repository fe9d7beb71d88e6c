#pragma once

#include "verification/verification.h"

namespace couture::verification {

/// Hyperelastic bodies that are meshed again on the way, and paths through limit points.
[[nodiscard]] std::vector<Case> remeshing_cases();

}  // namespace couture::verification
