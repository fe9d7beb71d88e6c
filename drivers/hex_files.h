#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "meshing/volume/hex_sampling.h"

namespace couture::drivers {

/// What was written of hexahedra.
struct HexFiles {
    long n_nodes = 0;
    long n_elements = 0;
    std::vector<std::filesystem::path> files;
};

/// Writes hexahedra as STEM.vtu (cells of 8 nodes) and as STEM.inp with the boundary sets as sets
/// of nodes.
///
/// @throws FileError  if one can't be written
HexFiles write_hexahedra(const std::filesystem::path& stem,
                         const meshing::SampledHexahedra& sampled, const std::string& provenance);

}  // namespace couture::drivers
