#include "io/virtual_display.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <bit>
#include <cstddef>
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

/// A connection to the display's local socket, -1 if there is none.
///
/// @param is_abstract  by the name that is no file, which a server has where it may make none
int connect_to(const std::string& number, bool is_abstract) {
    const std::string name = "/tmp/.X11-unix/X" + number;
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    const std::size_t start = is_abstract ? 1 : 0;
    if (name.size() + start >= sizeof(address.sun_path)) return -1;
    name.copy(address.sun_path + start, name.size());
    const int connection = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (connection < 0) return -1;
    const std::size_t length = offsetof(sockaddr_un, sun_path) + start + name.size();
    if (::connect(connection, reinterpret_cast<const sockaddr*>(&address),
                  static_cast<socklen_t>(length)) == 0) {
        return connection;
    }
    ::close(connection);
    return -1;
}

/// Whether the server takes the client: the first words of the X protocol, version 11.0, without
/// authorization.
bool is_accepted(int connection) {
    constexpr bool is_little = std::endian::native == std::endian::little;
    constexpr std::array<unsigned char, 12> request{is_little ? 'l' : 'B', 0, is_little ? 11 : 0,
                                                    is_little ? 0 : 11};
    if (::send(connection, request.data(), request.size(), MSG_NOSIGNAL) !=
        static_cast<ssize_t>(request.size())) {
        return false;
    }
    pollfd wait_for{connection, POLLIN, 0};
    unsigned char answer = 0;
    return ::poll(&wait_for, 1, start_timeout_ms) > 0 && ::read(connection, &answer, 1) == 1 &&
           answer == 1;
}

/// A client's connection, -1 if the server takes none in time.
int connect_client(const std::string& number) {
    constexpr int pause_ms = 20;
    for (int waited = 0; waited < start_timeout_ms; waited += pause_ms) {
        for (const bool is_abstract : {true, false}) {
            const int connection = connect_to(number, is_abstract);
            if (connection < 0) continue;
            if (is_accepted(connection)) return connection;
            ::close(connection);
        }
        ::poll(nullptr, 0, pause_ms);
    }
    return -1;
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
    connection_ = connect_client(number);
    if (connection_ < 0) {
        stop(server_);
        throw FileError("pictures: Xvfb started display :{} but takes no client within {} s",
                        number, start_timeout_ms / 1000);
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
    ::close(connection_);
    stop(server_);
}

}  // namespace couture::io
