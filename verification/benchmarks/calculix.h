#pragma once

#include "verification/verification.h"

namespace couture::verification {

/// Finite strain on meshes of degree 1 against CalculiX, whose plain 8-node brick is the same
/// discrete problem. Skipped where the program `ccx` is not installed.
[[nodiscard]] std::vector<Case> calculix_cases();

}  // namespace couture::verification
