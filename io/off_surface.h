#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "io/raw_surface.h"

namespace couture::io {

/// Points and faces of an OFF file in text, also with colours and normals, which are passed over.
///
/// @param file  its name, for messages
/// @throws FileError  with line
[[nodiscard]] RawSurface read_off(const std::string& file, std::string_view text);

/// Writes OFF with all digits; `provenance` (one line) becomes a comment.
///
/// @throws FileError  if it can't be written
void write_off(const std::filesystem::path& path, const meshing::TriangleSoup& soup,
               const std::string& provenance);

}  // namespace couture::io
