#pragma once

#include <filesystem>
#include <string_view>

#include "io/raw_surface.h"

namespace couture::io {

/// Points, polygons and triangle strips of a VTK XML PolyData file; lines, vertices and arrays are
/// passed over.
///
/// @param bytes  of the file, to compare its counts with
/// @throws FileError  with what VTK says, and for counts that a file of that size cannot hold
[[nodiscard]] RawSurface read_vtp(const std::filesystem::path& path, std::string_view bytes);

}  // namespace couture::io
