#pragma once

#include <optional>

#include "iga/topology/space.h"
#include "io/deck.h"
#include "io/spline_file.h"

namespace couture::drivers {

/// The deck's geometry (file, built-in part, or volume that is meshed) with the sets that the deck
/// adds.
///
/// @throws FileError, InputError, TopologyError  what reading, building or meshing it throws, and
///                                               for a set whose entities can't be read or do not
///                                               exist
[[nodiscard]] io::AnyMultiPatch load_geometry(const io::Deck& deck);

/// Adds the sets of [geometry.sets]. @throws InputError  for entities that do not exist
void add_deck_sets(const io::GeometrySource& source, io::AnyMultiPatch& geometry);

/// "patch 3 side 0:low", "patch 3 edge 0:low 2:high" or "patch 3 corner 0:low 1:low 2:high".
/// @throws InputError  for anything else, and for a patch that does not exist
template <int d>
[[nodiscard]] iga::PatchEntity<d> parse_entity(const std::string& text, int n_patches);

/// 'elements' of the deck's discretization in each direction, or nothing.
/// @throws InputError  if they are neither one number nor one per direction
template <int d>
[[nodiscard]] std::optional<std::array<int, d>> elements_per_direction(
    const io::Discretization& discretization);

/// The space that the deck's discretization makes of the geometry.
/// @throws InputError   naming where the discretization was written
/// @throws SolverError  before anything large is made, if its matrix alone would not fit into
/// memory
///                      or its unknowns can't be numbered: the numbers
template <int d>
[[nodiscard]] iga::SpacePtr<d> make_space(const io::Deck& deck, const iga::MultiPatch<d>& geometry);

}  // namespace couture::drivers
