#pragma once

#include <filesystem>

#include "drivers/mesh_stages.h"
#include "io/deck.h"

namespace couture::drivers {

/// Makes the volume that a job's `mesh` describes: its deck for meshing with the job's parameters,
/// up to the stage volume, whatever stage or family it names.
///
/// @param like  decisions of another member that are repeated (io::write_layout_record); empty:
///              those of the deck, if any
/// @return with solid->volume, certified valid
/// @throws what read_mesh_deck and run_mesh_stages throw; InputError if the job names parameters
/// and
///         the deck no part; GeometryError if det J is not proven positive: patch and what to do
[[nodiscard]] MeshStages mesh_geometry(const io::Deck& deck,
                                       const std::filesystem::path& like = {});

}  // namespace couture::drivers
