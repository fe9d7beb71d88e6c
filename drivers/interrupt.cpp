#include "drivers/interrupt.h"

#include <pthread.h>
#include <signal.h>
#include <unistd.h>

#include <cstdio>
#include <thread>

#include "drivers/commands/commands.h"
#include "io/atomic_file.h"

namespace couture::drivers {

void exit_cleanly_on_interrupt() {
    // A thread of its own waits for the signals, which all other threads block: it may lock and
    // remove files, which a signal handler must not.
    static sigset_t signals;
    sigemptyset(&signals);
    sigaddset(&signals, SIGINT);
    sigaddset(&signals, SIGTERM);
    pthread_sigmask(SIG_BLOCK, &signals, nullptr);
    std::thread([] {
        int signal = 0;
        sigwait(&signals, &signal);
        io::remove_temporaries();
        std::fputs("couture: interrupted\n", stderr);
        ::_exit(ExitCode::interrupted);
    }).detach();
}

}  // namespace couture::drivers
