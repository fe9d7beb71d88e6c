#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "iga/core/types.h"

namespace couture::io {

/// One row per point or per cell.
struct NamedRows {
    std::string name;
    MatrixX rows;
};

/// What a VTK XML file of an unstructured grid holds.
struct VtuMesh {
    /// n_points x 3.
    MatrixX points;
    /// VTK's number of each cell's kind, and its points.
    std::vector<int> cell_types;
    std::vector<std::vector<long>> cells;
    std::vector<NamedRows> point_arrays;
    std::vector<NamedRows> cell_arrays;
    /// The field data string of that name; may be empty.
    std::string provenance;
};

/// Reads one `.vtu` file, or the pieces of a `.pvtu` file.
///
/// @throws FileError  if it is missing, not such a file, or cut off
[[nodiscard]] VtuMesh read_vtu(const std::filesystem::path& path);

}  // namespace couture::io
