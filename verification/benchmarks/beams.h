#pragma once

#include "verification/verification.h"

namespace couture::verification {

/// Cantilever: the exact plane stress solution, and a clamped solid against beam theory. Source:
/// [TimoshenkoGoodier70] Art. 21.
[[nodiscard]] std::vector<Case> beam_cases();

}  // namespace couture::verification
