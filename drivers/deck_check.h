#pragma once

#include <limits>

#include "iga/topology/jacobian_certificate.h"
#include "iga/topology/multipatch.h"
#include "io/deck.h"

namespace couture::drivers {

/// What is proven of det J on the whole geometry.
struct GeometryCertificate {
    /// Of the worst patch: folded, then undecided, then degenerate.
    iga::Validity validity = iga::Validity::valid;
    /// Smallest orientation * det J found on any patch, and on which.
    double min_jacobian = std::numeric_limits<double>::infinity();
    int patch = 0;
};

/// Checks what a deck says against its geometry: kinematics fit the dimension, sets exist and are
/// of the right kind, materials cover every patch once, patch numbers exist, probes name what there
/// is.
/// Warns of patches that are folded, singular somewhere, or not proven to be neither.
///
/// @throws InputError  with all that is wrong, each with its place in the deck
template <int d>
GeometryCertificate check_deck(const io::Deck& deck, const iga::MultiPatch<d>& geometry);

}  // namespace couture::drivers
