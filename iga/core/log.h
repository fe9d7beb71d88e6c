#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace couture::log {

/// What is printed on standard error (warnings, unless told); results go to standard output.
enum class Level { quiet, warnings, progress, detail };
void set_level(Level level);

void info(std::string_view message);
void detail(std::string_view message);
/// Prints the message and keeps it for `warnings`.
void warn(std::string_view message);

/// All warnings since the last `clear_warnings`, in order, each text once.
[[nodiscard]] std::vector<std::string> warnings();
void clear_warnings();

}  // namespace couture::log
