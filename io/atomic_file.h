#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace couture::io {

/// Lets `write` fill a temporary file beside `path`, then renames it: the file appears whole or
/// not at all. Missing folders are made. The temporary name keeps the extension.
///
/// @throws FileError  naming the path and the system's reason; the temporary file is removed
void write_atomically(const std::filesystem::path& path,
                      const std::function<void(const std::filesystem::path& temporary)>& write);

/// Removes what killed programs left of writes into `folder` whose files' names begin with `stem`.
/// None of these writes may be under way.
void remove_leftovers(const std::filesystem::path& folder, const std::string& stem);

/// Says before a long run what would stop its results: makes nothing.
///
/// @throws FileError  if `folder`, or the nearest folder above it that exists, can't be written to
void require_writable(const std::filesystem::path& folder);

/// Writes a text at hand in the same way.
void write_text(const std::filesystem::path& path, std::string_view text);

/// Removes the temporary files of all writes under way: for a program that is about to end. Writes
/// that go on afterwards wait for ever.
void remove_temporaries();

/// The whole file. @throws FileError  if it is missing, a folder or can't be read
[[nodiscard]] std::string read_text(const std::filesystem::path& path);

}  // namespace couture::io
