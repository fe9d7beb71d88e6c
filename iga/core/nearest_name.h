#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace couture {

/// Number of insertions, deletions and replacements that turn one text into the other, upper and
/// lower case counted as equal.
[[nodiscard]] int edit_distance(std::string_view a, std::string_view b);

/// The candidate with the smallest edit distance to `name`, the first of several; nothing if there
/// are no candidates. For "did you mean" in messages.
[[nodiscard]] std::optional<std::string> nearest_name(std::string_view name,
                                                      const std::vector<std::string>& candidates);

}  // namespace couture
