#include "io/did_you_mean.h"

#include <fmt/format.h>

#include <algorithm>

#include "iga/core/nearest_name.h"

namespace couture::io {

std::string did_you_mean(std::string_view name, const std::vector<std::string>& candidates) {
    const std::optional<std::string> nearest = nearest_name(name, candidates);
    const int longest_slip = std::max(1, (static_cast<int>(name.size()) + 1) / 3);
    if (!nearest || edit_distance(name, *nearest) > longest_slip) {
        return {};
    }
    return fmt::format("; did you mean '{}'?", *nearest);
}

std::string quoted_list(const std::vector<std::string>& names) {
    if (names.empty()) {
        return "(none)";
    }
    return fmt::format("'{}'", fmt::join(names, "', '"));
}

}  // namespace couture::io
