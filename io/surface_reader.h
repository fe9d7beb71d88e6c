#pragma once

#include <filesystem>
#include <string>

#include "io/raw_surface.h"
#include "meshing/surface/surface_mesh.h"

namespace couture::io {

/// A surface with what was done on reading.
struct SurfaceFile {
    meshing::TriangleSoup soup;
    /// "STL", "Wavefront OBJ", "OFF", "PLY", "VTK PolyData"; "part" for one that was built.
    std::string format;
    /// As the file has them.
    int n_points_read = 0;
    int n_polygons_read = 0;
    /// Points that are exactly equal to one before them.
    int n_merged = 0;
    /// Polygons with more than three corners, which were split into triangles.
    int n_split = 0;
    /// Triangles in which a point stood twice, and polygons of fewer than three corners.
    int n_degenerate = 0;
    /// Points of no triangle.
    int n_unused = 0;
};

/// Whether the ending of a file's name, in small or capital letters, is that of a surface: .stl,
/// .obj, .off, .ply or .vtp.
[[nodiscard]] bool is_surface_file(const std::filesystem::path& path);

/// The triangles of a surface file, in the order of the file; its ending says the format: .stl
/// (text or binary), .obj (points and faces), .off (text, also with colours and normals), .ply
/// (text, binary of either byte order), .vtp (polygons and triangle strips); what else they hold is
/// passed over. Polygons are split as meshing/surface/polygon_triangles.h says. Points that are
/// exactly equal become one (0 and -0 are equal), triangles in which a point then stands twice are
/// dropped, and so are points of no triangle. Lengths are in the unit of the file.
///
/// @throws FileError  with file and line (binary: byte), if the file is missing, empty, cut short,
///                    in another format, holds numbers that are not finite, points that do not
///                    exist, another number of things than it says, polygons of too many corners or
///                    no triangles
[[nodiscard]] SurfaceFile read_surface_file(const std::filesystem::path& path);

/// Points and polygons of a surface file as they are: nothing is merged, split or dropped, numbers
/// are those of the file. In STL no two triangles share a point.
///
/// @throws FileError  as read_surface_file, and for no polygons
[[nodiscard]] RawSurface read_polygons(const std::filesystem::path& path);

/// Only the triangles of `read_surface_file`.
[[nodiscard]] meshing::TriangleSoup read_surface(const std::filesystem::path& path);

}  // namespace couture::io
