#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "io/raw_surface.h"

namespace couture::io {

/// Points and faces of a PLY file: text, binary of either byte order. Of the element "vertex" x, y
/// and z are taken, of "face" the list "vertex_indices" or "vertex_index"; all else is passed over.
///
/// @param file  its name, for messages
/// @throws FileError  with line (behind the header of a binary file: byte)
[[nodiscard]] RawSurface read_ply(const std::string& file, std::string_view bytes);

/// Writes binary PLY, little-endian, coordinates in double precision; `provenance` (one line)
/// becomes a comment.
///
/// @throws FileError  if it can't be written
void write_ply(const std::filesystem::path& path, const meshing::TriangleSoup& soup,
               const std::string& provenance);

}  // namespace couture::io
