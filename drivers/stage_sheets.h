#pragma once

#include <filesystem>
#include <vector>

#include "drivers/mesh_stages.h"

namespace couture::drivers {

/// Pictures of several stages, each on one sheet.
///
/// STEM_relocation.png, if nodes moved: quads before and after, and the energy of each step.
/// STEM_stages.png, if a volume was made: surface, pants, layout, field (or, without one, map),
/// quads, volume.
///
/// @return the files
/// @throws FileError  if one can't be written
///
/// Source: [Maquart19] Figs. 4.11, 4.12
std::vector<std::filesystem::path> write_stage_sheets(const std::filesystem::path& stem,
                                                      const MeshStages& stages);

}  // namespace couture::drivers
