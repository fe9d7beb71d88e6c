#pragma once

#include <string_view>

namespace couture::io {

/// The file meshing/layout/templates.toml.
extern const std::string_view built_in_templates_text;

}  // namespace couture::io
