#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "meshing/layout/cuboid_template.h"

namespace couture::io {

/// The templates of meshing/layout/templates.toml, which says how entries are written.
[[nodiscard]] meshing::TemplateLibrary built_in_templates();

/// Adds the entries [[template]] of a file of the user's.
///
/// @throws FileError   if it can't be read
/// @throws InputError  with all entries that are wrong: file, line, template and rule. The library
///                     has the others then
void add_templates(const std::filesystem::path& path, meshing::TemplateLibrary& library);

/// The same for a text at hand; `name` is what messages call it.
void parse_templates(std::string_view text, const std::string& name,
                     meshing::TemplateLibrary& library);

}  // namespace couture::io
