#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "io/raw_surface.h"
#include "meshing/surface/quad_grid.h"

namespace couture::io {

/// Points and faces of a Wavefront OBJ file; all else is passed over.
///
/// @param file  its name, for messages
/// @throws FileError  with line
[[nodiscard]] RawSurface read_obj(const std::string& file, std::string_view text);

/// Writes OBJ with all digits; `provenance` (one line) becomes a comment.
///
/// @throws FileError  if it can't be written
void write_obj(const std::filesystem::path& path, const meshing::TriangleSoup& soup,
               const std::string& provenance);

/// The same for a quad mesh.
void write_obj(const std::filesystem::path& path, const meshing::QuadMesh& quads,
               const std::string& provenance);

}  // namespace couture::io
