#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "io/toml_node.h"

namespace couture::io {

/// The document in `text`; `name` is what messages call it.
///
/// @throws InputError  for what is not TOML, with line and caret; for bytes that are not text, and
///                     for values nested deeper than 100
[[nodiscard]] TomlNode parse_toml(std::string_view text, const std::string& name);

/// Changes one value: "solver.tolerance=1e-8", "pressure.0.value='2 MPa'" (lists by index).
/// Sections that are missing are made. What is not a TOML value is taken as a text.
///
/// @throws InputError  if the assignment has no '=' or goes through something that holds no values
void override_value(TomlNode& document, const std::string& assignment);

}  // namespace couture::io
