#pragma once

#include "iga/topology/multipatch.h"
#include "io/deck.h"

namespace couture::drivers {

/// Checks what a deck says against its geometry: kinematics fit the dimension, sets exist and are
/// of the right kind, materials cover every patch once, patch numbers exist, probes name what there
/// is.
/// Warns of patches that are folded, singular somewhere, or not proven to be neither.
///
/// @throws InputError  with all that is wrong, each with its place in the deck
template <int d>
void check_deck(const io::Deck& deck, const iga::MultiPatch<d>& geometry);

}  // namespace couture::drivers
