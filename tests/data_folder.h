#pragma once

#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <optional>

namespace couture::test {

/// Folder of outside data: $COUTURE_DATA, else shared/data beside the source folder. Nothing, with
/// a warning, where there is none; a failure in continuous integration (environment variable CI).
inline std::optional<std::filesystem::path> data_folder() {
    const char* variable = std::getenv("COUTURE_DATA");
    const std::filesystem::path folder =
        variable != nullptr ? std::filesystem::path(variable)
                            : std::filesystem::path(COUTURE_SOURCE_DIR) / ".." / "shared" / "data";
    if (std::filesystem::is_directory(folder)) {
        return folder;
    }
    if (std::getenv("CI") != nullptr) {
        FAIL("outside data is missing: " << folder.string() << "; set COUTURE_DATA");
    }
    WARN("skipped: no outside data at " << folder.string() << "; set COUTURE_DATA");
    return std::nullopt;
}

}  // namespace couture::test
