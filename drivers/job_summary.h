#pragma once

#include "drivers/summary.h"
#include "iga/topology/multipatch.h"
#include "io/deck.h"

namespace couture::drivers {

/// What a summary says of the deck and its geometry, whatever is solved on them.
template <int d>
[[nodiscard]] Summary describe_job(const io::Deck& deck, const iga::MultiPatch<d>& geometry,
                                   const GeometryCertificate& certificate);

}  // namespace couture::drivers
