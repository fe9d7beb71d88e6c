#pragma once

#include <filesystem>

#include "iga/solve/linear_static.h"
#include "io/deck.h"

namespace couture::drivers {

/// Draws the deformed part, coloured by the deck's quantity, with a legend; displacements are
/// enlarged by the deck's scale, or so that the largest is a tenth of the part (never made
/// smaller).
///
/// @param stress  coefficients of the stress (Poisson: the flux), n_dofs x 6
/// @throws FileError  if it can't be written or pictures can't be made here
template <int d>
void write_picture(const std::filesystem::path& path, const io::Deck& deck,
                   const iga::SpacePtr<d>& space, const iga::CaseResult<d>& result,
                   const MatrixX& stress);

}  // namespace couture::drivers
