#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "io/scene.h"
#include "meshing/pipeline/solid_mesh.h"

namespace couture::drivers {

/// The picture of a stage that was run: quads of the layout; streamlines and singularities of the
/// field (of positive index red, others blue); quads where the map puts them, or its flipped
/// triangles (red) if there are some; quads; the volume.
[[nodiscard]] io::Scene solid_scene(const meshing::SolidMesh& solid, meshing::SolidStage stage);

/// Writes what a stage shows: STEM.vtp (layout and map: the surface with the number of its quad on
/// each triangle and arcs as curves, kind 6, along sharp edges 7; field: also the four directions
/// of its cross and, on the points, indices of singularities in quarter turns; quads: the quads,
/// also as STEM.obj), STEM.xml (the boundary's surfaces, the volume) or what write_hexahedra does,
/// and with `png` STEM.png.
///
/// @return the files; none of a field or surfaces that were not made
/// @throws FileError  if one can't be written
std::vector<std::filesystem::path> write_solid_stage(const std::filesystem::path& stem,
                                                     const meshing::SolidMesh& solid,
                                                     meshing::SolidStage stage, bool png,
                                                     const std::string& provenance);

}  // namespace couture::drivers
