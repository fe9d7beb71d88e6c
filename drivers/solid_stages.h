#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "io/scene.h"
#include "meshing/pipeline/solid_mesh.h"

namespace couture::drivers {

/// The picture of a stage that was made: the layout for the map, too.
[[nodiscard]] io::Scene solid_stage_scene(const meshing::SolidMesh& solid,
                                          meshing::SolidStage stage);

/// Writes what a stage shows: STEM.vtp (layout and map: the surface with the number of its quad on
/// each triangle and arcs as curves, kind 6, along sharp edges 7; field: also the four directions
/// of its cross and, on the points, indices of singularities in quarter turns; quads: the quads,
/// also as STEM.obj) or STEM.xml (the volume), and with `png` STEM.png.
///
/// @return the files; none of a field that was not made
/// @throws FileError  if one can't be written
std::vector<std::filesystem::path> write_solid_stage(const std::filesystem::path& stem,
                                                     const meshing::SolidMesh& solid,
                                                     meshing::SolidStage stage, bool png,
                                                     const std::string& provenance);

}  // namespace couture::drivers
