#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "io/raw_surface.h"

namespace couture::io {

/// Triangles of an STL file in text or binary, each with points of its own.
///
/// @param file  its name, for messages
/// @throws FileError  with line (binary: byte)
[[nodiscard]] RawSurface read_stl(const std::string& file, std::string_view bytes);

/// Writes binary STL: single precision, normals from the triangles. The first 80 bytes of
/// `provenance` become its title.
///
/// @return warnings: how many points single precision makes equal
/// @throws InputError  for coordinates beyond single precision
/// @throws FileError   if it can't be written
std::vector<std::string> write_stl(const std::filesystem::path& path,
                                   const meshing::TriangleSoup& soup,
                                   const std::string& provenance);

}  // namespace couture::io
