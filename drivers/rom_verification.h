#pragma once

#include "verification/verification.h"

namespace couture::drivers {

/// Reduced models of the decks in drivers/decks, trained and compared with full solutions at points
/// of their own. All are long; they are skipped where there is no folder drivers/decks. Snapshots
/// are kept in out/verify: what is there is not computed again.
[[nodiscard]] std::vector<verification::Case> reduced_model_cases();

}  // namespace couture::drivers
