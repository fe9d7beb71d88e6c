#include "tests/drivers/run_program.h"

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>

#include "io/atomic_file.h"

namespace couture::tests {

namespace fs = std::filesystem;

ProgramResult run_couture(const std::string& arguments, const fs::path& folder,
                          const std::string& before, const std::string& launcher) {
    const TemporaryFolder logs;
    const fs::path output = logs.path() / "output";
    const fs::path errors = logs.path() / "errors";
    const std::string command =
        fmt::format("exec >'{}' 2>'{}' </dev/null; cd '{}'; {}; {} '{}' {}", output.string(),
                    errors.string(), folder.string(), before, launcher, COUTURE_PROGRAM, arguments);
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), io::read_text(output),
            io::read_text(errors)};
}

TemporaryFolder::TemporaryFolder() {
    static std::atomic<int> n_folders = 0;
    path_ = fs::temp_directory_path() / fmt::format("couture_{}_{}", ::getpid(), n_folders++);
    fs::create_directories(path_);
}

TemporaryFolder::~TemporaryFolder() {
    std::error_code code;
    fs::remove_all(path_, code);
}

}  // namespace couture::tests
