#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "iga/topology/multipatch.h"

namespace couture::io {

/// What a spline file holds: surfaces (in the plane or in space) or volumes.
using AnyMultiPatch = std::variant<iga::MultiPatch<2>, iga::MultiPatch<3>>;

struct SplineFile {
    AnyMultiPatch multipatch;
    /// "G+Smo XML", "MFEM NURBS mesh", "GeoPDEs text", "yeti inp/NB", "Couture HDF5".
    std::string format;
    /// What was repaired, refined or left out on reading.
    std::vector<std::string> notes;
};

/// Reads a multipatch; the format follows from the extension and the first bytes. Interfaces are
/// those of the file, checked; where it lists none they are found.
///
/// @throws FileError  naming file, line, what was found and what was expected
[[nodiscard]] SplineFile read_splines(const std::filesystem::path& path);

/// The surfaces in space of a file, as they are: interfaces are neither read nor found, borders
/// may be shared by many.
///
/// @return nothing for a file of volumes
/// @throws FileError  as read_splines, and for surfaces in the plane
[[nodiscard]] std::optional<std::vector<iga::Surface>> read_spline_surfaces(
    const std::filesystem::path& path);

/// Whether the extension is one of splines: .xml, .mesh, .txt, .inp, .h5.
[[nodiscard]] bool is_spline_file(const std::filesystem::path& path);

/// Writes in the format of the extension (.xml, .mesh, .txt, .inp with .NB beside it, .h5), all
/// digits kept. The file appears whole or not at all.
///
/// @throws FileError   if it can't be written
/// @throws InputError  if the format can't say it (surfaces in space to MFEM, edge sets to
///                     GeoPDEs, ...): says what, and which formats can
void write_splines(const std::filesystem::path& path, const AnyMultiPatch& multipatch);

}  // namespace couture::io
