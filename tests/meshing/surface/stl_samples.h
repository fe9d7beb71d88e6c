#pragma once

#include <filesystem>

#include "meshing/surface/surface_mesh.h"

namespace couture::meshing {

/// Triangles of an STL file, text or binary; points with the same coordinates are one vertex,
/// numbered in the order of their first triangle.
[[nodiscard]] TriangleSoup read_stl(const std::filesystem::path& path);

}  // namespace couture::meshing
