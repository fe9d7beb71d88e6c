#pragma once

#include <filesystem>

#include "meshing/layout/layout_record.h"

namespace couture::io {

/// Writes the decisions of a decomposition as JSON; appears whole or not at all.
///
/// @throws FileError  if it can't be written
void write_pants_record(const std::filesystem::path& path, const meshing::PantsRecord& record,
                        const std::string& provenance);

/// The same with the decisions of a layout.
///
/// @throws FileError  if it can't be written
void write_layout_record(const std::filesystem::path& path, const meshing::PantsRecord& pants,
                         const meshing::LayoutRecord& layout, const std::string& provenance);

/// Either of the two.
///
/// @throws FileError  if it can't be read, is no such file or holds what makes no decomposition:
///                    says where
[[nodiscard]] meshing::MemberRecord read_member_record(const std::filesystem::path& path);

}  // namespace couture::io
