#pragma once

#include <filesystem>

#include "drivers/mesh_stages.h"
#include "io/deck.h"
#include "io/mesh_deck.h"

namespace couture::drivers {

/// The deck for meshing that a job's `mesh` names, with the job's parameters and surface, up to the
/// stage volume, whatever stage or family it names.
///
/// @param like  decisions of another member that are repeated (io::write_layout_record); empty:
///              those of the deck, if any
/// @throws what read_mesh_deck throws; InputError if the job names parameters and the deck no part,
///         and for other units
[[nodiscard]] io::MeshDeck member_mesh_deck(const io::Deck& deck,
                                            const std::filesystem::path& like = {});

/// Makes the volume of that deck.
///
/// @return with solid->volume, certified valid
/// @throws what member_mesh_deck and run_mesh_stages throw; GeometryError if det J is not proven
///         positive: patch and what to do
[[nodiscard]] MeshStages mesh_geometry(const io::Deck& deck,
                                       const std::filesystem::path& like = {});

}  // namespace couture::drivers
