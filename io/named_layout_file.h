#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/units.h"
#include "meshing/layout/volumetric_layout.h"

namespace couture::io {

/// A layout of cuboids that was written by hand.
struct NamedLayout {
    /// With the names of its nodes.
    meshing::PlacedLayout placed;
    /// How far nodes may lie from where they belong on the surface; nothing: not said.
    std::optional<double> tolerance;
};

/// Reads a TOML file of named nodes and of cuboids between them:
/// ```
/// tolerance = 0.5
/// [nodes]
/// a = [0, 0, 0]
/// b = "x_high-y_low-z_low"
/// [[cuboid]]
/// nodes = ["a", "b", ...]
/// ```
/// A node lies at a point, or at a corner of the part, by its name. Node i of a cuboid's eight lies
/// at (i & 1, i >> 1 & 1, i >> 2 & 1) of it; mirrored ones are turned.
///
/// @param corners  of the part, by their names; none of files
/// @param units    of plain numbers
/// @throws InputError  with all that is wrong: file, line, what was found and what was expected
/// @throws FileError   if it can't be read, or as read_volumetric_layout, for the cuboids, which
/// are
///                     counted from 0
[[nodiscard]] NamedLayout read_named_layout(const std::filesystem::path& path,
                                            const std::map<std::string, Vector3>& corners = {},
                                            const UnitSystem& units = UnitSystem());

/// The same for a text at hand; `name` is what messages call it.
[[nodiscard]] NamedLayout parse_named_layout(const std::string& name, std::string_view text,
                                             const std::map<std::string, Vector3>& corners = {},
                                             const UnitSystem& units = UnitSystem());

}  // namespace couture::io
