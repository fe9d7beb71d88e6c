#pragma once

#include "verification/verification.h"

namespace couture::verification {

/// Volumes, areas, certificates and counts of shapes known in closed form.
[[nodiscard]] std::vector<Case> known_shape_cases();

}  // namespace couture::verification
