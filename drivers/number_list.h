#pragma once

#include <string>
#include <vector>

namespace couture::drivers {

/// The numbers of "1,-2.5,3e2".
///
/// @param names  what they are, parted by commas; as many must be given. Empty: one or more.
/// @throws InputError  for anything else: names command, option and text
[[nodiscard]] std::vector<double> read_number_list(const std::string& command,
                                                   const std::string& option,
                                                   const std::string& text,
                                                   const std::string& names = "");

}  // namespace couture::drivers
