#pragma once

#include <array>

#include "meshing/surface/cut_surface.h"

namespace couture::meshing {

/// Opens a pant to a disc along two seams that don't meet: the shortest one between its boundaries
/// `first` and `middle`, and the shortest one from there to `last`. Chords are split so that there
/// are such.
///
/// @param first, middle, last  numbers in boundary_loops(), all different
/// @return the corners of the disc, counter-clockwise: both ends of the first boundary, then up
///         the right-hand side the middle boundary where it begins and ends, both ends of the last
///         boundary, and down the left-hand side the same
/// @throws TopologyError  if the piece is no pant
/// @throws InputError     for a boundary that does not exist or is named twice
///
/// Source: [Maquart19] Sec. 3.2.2.1, step 1. Differs: the third boundary is not filled, but opened
/// as well.
[[nodiscard]] std::array<int, 8> open_pant(CutSurface& pant, int first, int middle, int last);

/// The same with the two shortest of the three seams.
[[nodiscard]] std::array<int, 8> open_pant(CutSurface& pant);

}  // namespace couture::meshing
