#pragma once

#include <filesystem>
#include <string>

#include "iga/topology/element_quality.h"
#include "meshing/layout/volumetric_layout.h"

namespace couture::io {

/// Whether a file is a mesh of hexahedra for read_volumetric_layout: it ends on .vtk, or on .mesh
/// and its text starts as Medit's does (MFEM has the same ending).
[[nodiscard]] bool is_hex_mesh_file(const std::filesystem::path& path);

/// Quality of hexahedra, each a trilinear element of its own: measured as that of a volume of
/// splines, at the corners and the 2 x 2 x 2 Gauss points. Patches are the hexahedra.
[[nodiscard]] iga::QualitySummary<3> hex_quality(const meshing::PlacedLayout& mesh);

/// What `couture info FILE` prints of a mesh of hexahedra: how many and their points, quads and
/// Euler characteristic of the boundary, bounding box, volume, element quality (scaled Jacobian,
/// shape ratio, angle deviation in radians), and the length of an edge of a cube as large as the
/// mean hexahedron, which splines of equal element size get by --element-size.
[[nodiscard]] std::string hex_mesh_info_text(const std::string& name,
                                             const meshing::PlacedLayout& mesh);

/// The same for machines: one JSON object, indented by two. An infinite shape ratio is null.
[[nodiscard]] std::string hex_mesh_info_json(const meshing::PlacedLayout& mesh);

}  // namespace couture::io
