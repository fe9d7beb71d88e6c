#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace couture::io {

/// "; did you mean 'youngs_modulus'?" if a candidate is near enough to be a slip, else empty.
[[nodiscard]] std::string did_you_mean(std::string_view name,
                                       const std::vector<std::string>& candidates);

/// "'a', 'b', 'c'", or "(none)".
[[nodiscard]] std::string quoted_list(const std::vector<std::string>& names);

}  // namespace couture::io
