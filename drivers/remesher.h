#pragma once

#include "iga/solve/load_stepping.h"
#include "io/deck.h"

namespace couture::drivers {

/// When the body of a hyperelastic deck is meshed again, and how; never without [remeshing].
///
/// @param geometry  the undeformed body
/// @throws InputError  if the deck asks for a remeshing of what can't be meshed again
template <int d>
[[nodiscard]] iga::Remeshing<d> make_remeshing(const io::Deck& deck,
                                               const iga::MultiPatch<d>& geometry);

}  // namespace couture::drivers
