#include "drivers/worker_processes.h"

#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <thread>

#include "iga/core/error.h"

namespace couture::drivers {

namespace {

constexpr const char* this_program = "/proc/self/exe";
constexpr int cannot_start = 127;

pid_t start(const std::vector<std::string>& arguments) {
    std::string name = "couture";
    std::vector<std::string> texts = arguments;
    std::vector<char*> argv{name.data()};
    for (std::string& text : texts) argv.push_back(text.data());
    argv.push_back(nullptr);
    const pid_t parent = getpid();
    const pid_t child = fork();
    if (child < 0) {
        throw SolverError("a process can't be started: {}; take fewer --jobs",
                          std::strerror(errno));
    }
    if (child == 0) {
        prctl(PR_SET_PDEATHSIG, SIGTERM);
        // The parent may be gone already.
        if (getppid() == parent) execv(this_program, argv.data());
        _exit(cannot_start);
    }
    return child;
}

}  // namespace

std::vector<int> run_processes(const std::vector<std::vector<std::string>>& arguments,
                               const std::function<void()>& watch) {
    std::vector<pid_t> children;
    for (const auto& one : arguments) children.push_back(start(one));
    std::vector<int> codes(children.size(), -1);
    std::size_t n_running = children.size();
    constexpr std::chrono::milliseconds pause{100};
    constexpr int pauses_per_watch = 5;
    for (int n_pauses = 0; n_running > 0; ++n_pauses) {
        std::this_thread::sleep_for(pause);
        for (std::size_t i = 0; i < children.size(); ++i) {
            int status = 0;
            if (codes[i] >= 0 || waitpid(children[i], &status, WNOHANG) != children[i]) continue;
            constexpr int signal_base = 128;
            codes[i] = WIFEXITED(status) ? WEXITSTATUS(status) : signal_base + WTERMSIG(status);
            --n_running;
        }
        if (n_pauses % pauses_per_watch == 0 || n_running == 0) watch();
    }
    return codes;
}

}  // namespace couture::drivers
