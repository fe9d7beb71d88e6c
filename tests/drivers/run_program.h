#pragma once

#include <filesystem>
#include <string>

namespace couture::tests {

struct ProgramResult {
    int exit_code = 0;
    std::string output;
    std::string errors;
};

/// Runs the program with these arguments (as in a shell) in `folder`.
///
/// @param before  a shell command to run first, such as "ulimit -f 4"
/// @param launcher  a command that starts the program, such as "mpirun -n 2"
[[nodiscard]] ProgramResult run_couture(const std::string& arguments,
                                        const std::filesystem::path& folder,
                                        const std::string& before = "true",
                                        const std::string& launcher = "");

/// An empty folder that is removed at the end of its life.
class TemporaryFolder {
  public:
    TemporaryFolder();
    ~TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

}  // namespace couture::tests
