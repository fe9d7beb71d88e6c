#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "meshing/surface/surface_mesh.h"

namespace couture::io {

/// Writes triangles in the format of the ending: .stl (binary), .obj, .off (text), .ply (binary),
/// .vtp. All digits are kept but in STL, which has single precision. The file appears whole or not
/// at all; missing folders are made.
///
/// @param provenance  where it comes from, one line; kept as title, comment or field data
/// @return warnings: what the format could not keep
/// @throws InputError  for coordinates beyond the format
/// @throws FileError   for another ending, and if the file can't be written
std::vector<std::string> write_surface(const std::filesystem::path& path,
                                       const meshing::TriangleSoup& soup,
                                       const std::string& provenance = "");

}  // namespace couture::io
