#pragma once

#include <string>
#include <string_view>

namespace couture::drivers {

/// FNV-1a hash of a text, 16 hexadecimal digits: tells inputs apart, no protection against intent.
[[nodiscard]] std::string fnv_hash(std::string_view text);

}  // namespace couture::drivers
