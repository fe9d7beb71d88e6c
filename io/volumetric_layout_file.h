#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "meshing/layout/volumetric_layout.h"

namespace couture::io {

/// Reads a coarse mesh of hexahedra: Medit (.mesh, text) or legacy VTK (.vtk, text, versions up to
/// 4). A hexahedron with a negative volume is a mirrored one: its two ends are exchanged. Points
/// that no hexahedron has are left out; the others keep their order. Other cells of a Medit file
/// are passed over.
///
/// @throws FileError  if it is missing, malformed, has no hexahedra or (VTK) other cells; a
///                    hexahedron has no volume or a point twice; or the boundary is no manifold, or
///                    not one that cuboids bound (judge_layout): names the file and the line or the
///                    hexahedron, counted from 0
[[nodiscard]] meshing::PlacedLayout read_volumetric_layout(const std::filesystem::path& path);

/// A layout of hexahedra between points; checked and turned as read_volumetric_layout says, whose
/// errors it throws in the name of a file.
///
/// @param names  of the points, for messages; empty: they have none
[[nodiscard]] meshing::PlacedLayout make_placed_layout(const std::string& name,
                                                       const std::vector<Vector3>& points,
                                                       std::vector<std::array<int, 8>> hexahedra,
                                                       const std::vector<std::string>& names = {});

/// The same for texts at hand; `name` is what messages call them.
[[nodiscard]] meshing::PlacedLayout parse_medit_layout(const std::string& name,
                                                       std::string_view text);
[[nodiscard]] meshing::PlacedLayout parse_vtk_layout(const std::string& name,
                                                     std::string_view text);

}  // namespace couture::io
