#include "drivers/interrupt.h"

#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdio>
#include <thread>

#include "drivers/commands/commands.h"
#include "io/atomic_file.h"

namespace couture::drivers {

namespace {

/// Ends of a pipe: read, write.
std::array<int, 2> wake_up{-1, -1};

extern "C" void wake_watcher(int /*signal*/) {
    const char byte = 0;
    [[maybe_unused]] const auto n_written = ::write(wake_up[1], &byte, 1);
}

}  // namespace

void exit_cleanly_on_interrupt() {
    // A handler may hardly do anything: it wakes a thread that may lock and remove files.
    if (::pipe(wake_up.data()) != 0) {
        return;
    }
    std::thread([] {
        char byte = 0;
        while (::read(wake_up[0], &byte, 1) != 1) {
        }
        io::remove_temporaries();
        std::fputs("couture: interrupted\n", stderr);
        ::_exit(ExitCode::interrupted);
    }).detach();
    std::signal(SIGINT, wake_watcher);
    std::signal(SIGTERM, wake_watcher);
}

}  // namespace couture::drivers
