#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "io/picture.h"
#include "io/surface_info.h"
#include "io/units.h"
#include "meshing/surface/surface_mesh.h"

namespace couture::drivers {

/// What a command is told about a surface.
struct SurfaceInputOptions {
    /// A surface file, or the name of a part.
    std::string surface;
    /// Dimensions of a part: NAME=VALUE.
    std::vector<std::string> overrides;
    /// The same as numbers, in `units`.
    std::map<std::string, double> parameters;
    /// Edge length of a part's triangles, in `units`; 0: its default.
    double edge_length = 0.0;
    /// Of a part's points; parts are made in mm.
    io::UnitSystem units = io::UnitSystem();
    /// Repairs that change the surface (meshing/surface/fix_surface.h).
    bool fix = false;
    /// Closes every boundary loop.
    bool fill_holes = false;
    /// Takes one shell with its cavities.
    std::optional<int> shell;
};

/// Name and number of "NAME=NUMBER".
///
/// @throws InputError  for anything else: names the option
[[nodiscard]] std::pair<std::string, double> read_setting(const std::string& command,
                                                          const std::string& setting,
                                                          const char* option);

/// Whether a name is that of a part: it comes before files and folders, which are `./NAME`.
[[nodiscard]] bool is_part_input(const std::string& name);

/// Whether a name is a surface file by its ending, or that of a part.
[[nodiscard]] bool is_surface_input(const std::string& name);

/// @throws InputError  if a name is that of no file and no part, and has no ending: names the
///                     nearest part and lists all
void require_file_or_part(const std::string& command, const std::string& name);

/// Reads or builds a surface, repairs what is safe, fixes what was asked for, turns shells outwards
/// and checks. Nothing is printed.
///
/// @param command  that asks, for messages
/// @throws InputError   for options that do not fit, unknown parts, parameters and shells
/// @throws FileError    what reading throws
/// @throws GeometryError  if no triangle is left
[[nodiscard]] io::DescribedSurface load_surface(const std::string& command,
                                                const SurfaceInputOptions& options);

/// The mesh of a surface that can be meshed. Warns of triangles and shells that were turned, and of
/// flat triangles; open boundaries are said, not refused: they are the part's.
///
/// @param problems_file  written (see `write_problems`) if the surface is refused; empty: none is
/// @throws TopologyError   for edges and vertices that are no manifold, surfaces that can't be
///                         oriented, several shells, too few triangles
/// @throws GeometryError   for self-intersections; each with counts, the first places, the file
///                         that marks all of them, and what to do
[[nodiscard]] meshing::SurfaceMesh make_checked_mesh(const std::string& command,
                                                     const io::DescribedSurface& surface,
                                                     const std::filesystem::path& problems_file);

/// Writes a surface as VTP with the cell array "problem" (0 none, 1 open boundary, 2 non-manifold
/// edge, 3 non-manifold vertex, 4 inconsistent edge, 5 inside-out shell, 6 disjoint shell, 7 flat
/// triangle, 8 duplicate triangle, 9 self-intersection, 10 too few triangles, 11 no volume) and
/// open loops and bad edges as polylines with that number as "kind".
void write_problems(const std::filesystem::path& path, const io::DescribedSurface& surface);

/// The surface with the triangles and lines of its problems in red.
[[nodiscard]] io::Scene problems_scene(const io::DescribedSurface& surface);

}  // namespace couture::drivers
