#pragma once

#include "drivers/commands/commands.h"

namespace couture::drivers {

/// `couture mesh` of a spline file. Stage volume: surfaces in space, in any order, become
/// NAME_volume.xml and .vtu, one patch for each six of them. Stage hexes: hexahedra sampled from
/// these, or from the volumes of the file, become NAME_hexes.vtu and .inp.
///
/// Says what became of the surfaces.
///
/// @return done; run_failed if a volume or hexahedron is not certified positive: the files are
///         written all the same
/// @throws InputError  for another stage, and options that are for triangulated surfaces
/// @throws what reading, volumes_from_surfaces and sample_hexahedra throw
int mesh_splines(const MeshOptions& options, const CommonOptions& common);

}  // namespace couture::drivers
