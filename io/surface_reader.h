#pragma once

#include <filesystem>

#include "meshing/surface/surface_mesh.h"

namespace couture::io {

/// The triangles of a surface file, in the order of the file; its ending says the format:
/// .stl (ASCII or binary), .obj (points and faces, the rest is passed over), .off (also with
/// colours and normals, which are passed over). Polygons become fans around their first corner,
/// which suits convex ones only. Points that are exactly equal become one (0 and -0 are equal),
/// triangles in which a point then stands twice are dropped, and so are points of no triangle.
/// Lengths are in the unit of the file.
///
/// @throws FileError  with file and line (binary: byte), if the file is missing, empty, cut short,
///                    in another format, holds numbers that are not finite, points that do not
///                    exist, another number of things than it says, or no triangles
[[nodiscard]] meshing::TriangleSoup read_surface(const std::filesystem::path& path);

}  // namespace couture::io
