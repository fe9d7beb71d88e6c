#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "iga/core/types.h"
#include "io/raw_surface.h"
#include "meshing/surface/quad_grid.h"
#include "meshing/surface/surface_mesh.h"

namespace couture::io {

/// Values at the points, or on the triangles and curves, of a surface.
struct SurfaceArray {
    std::string name;
    /// One row per point, or one per triangle; 1 or 3 columns.
    MatrixX values;
};

/// A polyline on a surface.
struct SurfaceLine {
    std::vector<Vector3> points;
    bool is_closed = false;
    /// What is drawn: a number of its kind and its own number, in the cell arrays "kind" and
    /// "curve".
    int kind = 0;
    int number = 0;
};

/// Writes a surface and curves on it as VTK XML PolyData (.vtp). Cell arrays hold the triangles'
/// values; curves have NaN there. Triangles have -1 in "kind" and "curve", which are there if there
/// are curves. The file appears whole or not at all; missing folders are made.
///
/// @param provenance  where it comes from; kept as field data
/// @throws InputError  if an array has the wrong number of rows or columns, or a vertex number does
///                     not exist
/// @throws FileError   if the file can't be written
void write_vtp(const std::filesystem::path& path, const meshing::TriangleSoup& surface,
               std::span<const SurfaceArray> on_points = {},
               std::span<const SurfaceArray> on_triangles = {},
               std::span<const SurfaceLine> lines = {}, const std::string& provenance = "");

/// The same for a quad mesh.
void write_vtp(const std::filesystem::path& path, const meshing::QuadMesh& quads,
               const std::string& provenance = "");

/// The same for polygons, with values at their points.
void write_vtp(const std::filesystem::path& path, const RawSurface& polygons,
               std::span<const SurfaceArray> on_points, const std::string& provenance = "");

}  // namespace couture::io
