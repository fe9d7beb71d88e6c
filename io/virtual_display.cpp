#include "io/virtual_display.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <cstring>

#include "iga/core/error.h"

namespace couture::io {

namespace {

constexpr int start_timeout_ms = 20000;

/// The line that the server writes once it listens: its display number. Empty if none comes.
std::string read_line(int pipe) {
    std::string line;
    char letter = 0;
    pollfd wait_for{pipe, POLLIN, 0};
    while (::poll(&wait_for, 1, start_timeout_ms) > 0 && ::read(pipe, &letter, 1) == 1) {
        if (letter == '\n') {
            return line;
        }
        line += letter;
    }
    return {};
}

void stop(pid_t server) {
    ::kill(server, SIGTERM);
    ::waitpid(server, nullptr, 0);
}

/// Starts Xvfb, which writes its display number to `pipe`. `-terminate`: it ends with its last
/// client, even if this process is killed.
pid_t start_server(int pipe) {
    constexpr int server_pipe = 3;
    // The server must end on SIGTERM even where this process blocks it.
    posix_spawnattr_t attributes;
    sigset_t no_signals;
    sigemptyset(&no_signals);
    ::posix_spawnattr_init(&attributes);
    ::posix_spawnattr_setsigmask(&attributes, &no_signals);
    ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK);
    posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    ::posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    ::posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    ::posix_spawn_file_actions_adddup2(&actions, pipe, server_pipe);
    std::array<std::string, 10> words{"Xvfb",      "-displayfd", std::to_string(server_pipe),
                                      "-screen",   "0",          "640x480x24",
                                      "-nolisten", "tcp",        "-terminate",
                                      "-nocursor"};
    std::array<char*, words.size() + 1> arguments{};
    for (std::size_t i = 0; i < words.size(); ++i) {
        arguments[i] = words[i].data();
    }
    pid_t server = -1;
    const int reason =
        ::posix_spawnp(&server, "Xvfb", &actions, &attributes, arguments.data(), environ);
    ::posix_spawnattr_destroy(&attributes);
    ::posix_spawn_file_actions_destroy(&actions);
    if (reason != 0) {
        throw FileError(
            "pictures: Xvfb can't be started: {}; on Debian and Ubuntu install the package 'xvfb'",
            std::strerror(reason));
    }
    return server;
}

}  // namespace

VirtualDisplay::VirtualDisplay() {
    std::array<int, 2> pipe{};
    if (::pipe2(pipe.data(), O_CLOEXEC) != 0) {
        throw FileError("pictures: no pipe for Xvfb: {}", std::strerror(errno));
    }
    try {
        server_ = start_server(pipe[1]);
    } catch (...) {
        ::close(pipe[0]);
        ::close(pipe[1]);
        throw;
    }
    ::close(pipe[1]);
    const std::string number = read_line(pipe[0]);
    ::close(pipe[0]);
    if (number.empty()) {
        stop(server_);
        throw FileError("pictures: Xvfb did not start; try 'Xvfb -displayfd 1' to see why");
    }
    if (const char* display = std::getenv("DISPLAY")) {
        previous_ = display;
    }
    ::setenv("DISPLAY", (":" + number).c_str(), 1);
}

VirtualDisplay::~VirtualDisplay() {
    if (previous_) {
        ::setenv("DISPLAY", previous_->c_str(), 1);
    } else {
        ::unsetenv("DISPLAY");
    }
    stop(server_);
}

}  // namespace couture::io
