#pragma once

#include <filesystem>

#include "meshing/topology/pants_record.h"

namespace couture::io {

/// Writes the decisions of a decomposition as JSON; appears whole or not at all.
///
/// @throws FileError  if it can't be written
void write_pants_record(const std::filesystem::path& path, const meshing::PantsRecord& record,
                        const std::string& provenance);

/// @throws FileError  if it can't be read, is no such file or holds what makes no decomposition:
///                    says where
[[nodiscard]] meshing::PantsRecord read_pants_record(const std::filesystem::path& path);

}  // namespace couture::io
