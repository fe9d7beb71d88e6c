#pragma once

#include "io/vtk_writer.h"

namespace couture::io {

/// Writes the file that makes one of the pieces that several processes wrote by `write_vtu`, with
/// the same arrays, and `always_weights` alike.
///
/// @param pieces  their files, relative to the folder of `path`
/// @param points  arrays of which names, numbers and names of components count
/// @throws FileError  as `write_vtu`
void write_pvtu(const std::filesystem::path& path, std::span<const std::string> pieces,
                std::span<const PointArray> points, const VtuOptions& options);

}  // namespace couture::io
