#pragma once

#include "verification/verification.h"

namespace couture::verification {

/// Stresses and tangents against differences; homogeneous states and inflated tubes and spheres of
/// compressible neo-Hookean material.
[[nodiscard]] std::vector<Case> hyperelastic_cases();

}  // namespace couture::verification
