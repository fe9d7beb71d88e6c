#pragma once

#include <string_view>

namespace couture::io {

/// The page of rom/viewer, in one file; the model's data go where it says so.
extern const std::string_view built_in_page_text;

}  // namespace couture::io
