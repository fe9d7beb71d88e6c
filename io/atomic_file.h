#pragma once

#include <filesystem>
#include <functional>
#include <string_view>

namespace couture::io {

/// Lets `write` fill a temporary file beside `path`, then renames it: the file appears whole or
/// not at all. Missing folders are made. The temporary name keeps the extension.
///
/// @throws FileError  naming the path and the system's reason; the temporary file is removed
void write_atomically(const std::filesystem::path& path,
                      const std::function<void(const std::filesystem::path& temporary)>& write);

/// The same for a text that is at hand.
void write_text(const std::filesystem::path& path, std::string_view text);

/// Removes the temporary files of all writes under way: for a program that is about to end. Writes
/// that go on afterwards wait for ever.
void remove_temporaries();

/// The whole file. @throws FileError  if it is missing, a folder or can't be read
[[nodiscard]] std::string read_text(const std::filesystem::path& path);

}  // namespace couture::io
