#pragma once

#include "verification/verification.h"

namespace couture::verification {

/// Populations of shapes: modes in closed form, and quad meshes of one connectivity in cavities of
/// any topology.
[[nodiscard]] std::vector<Case> shape_cases();

}  // namespace couture::verification
