#include <fmt/core.h>

#include <csignal>
#include <filesystem>
#include <new>

#include "drivers/command_line.h"
#include "drivers/commands/commands.h"
#include "drivers/interrupt.h"
#include "drivers/summary.h"
#include "iga/core/error.h"
#include "iga/core/timer.h"
#include "iga/distributed/communicator.h"

namespace {

using namespace couture;

constexpr std::size_t least_memory = std::size_t{1} << 30U;

int report(const std::string& message, int exit_code, bool json) {
    fmt::print(stderr, "couture: {}\n", message);
    if (json) {
        fmt::print("{}", drivers::error_json(message, exit_code));
    }
    return exit_code;
}

/// What went wrong decides the exit code: 1 the run, 2 what it was given.
int run_guarded(const drivers::Command& command) {
    const bool json = command.common.json;
    try {
        return command.run();
    } catch (const SolverError& error) {
        return report(error.what(), drivers::ExitCode::run_failed, json);
    } catch (const Error& error) {
        return report(error.what(), drivers::ExitCode::bad_input, json);
    } catch (const std::filesystem::filesystem_error& error) {
        return report(fmt::format("{}: {}", error.path1().string(), error.code().message()),
                      drivers::ExitCode::bad_input, json);
    } catch (const std::bad_alloc&) {
        return report("out of memory; take fewer elements or a lower degree",
                      drivers::ExitCode::run_failed, json);
    } catch (const std::exception& error) {
        return report(fmt::format("unexpected error: {}", error.what()),
                      drivers::ExitCode::run_failed, json);
    }
}

}  // namespace

int main(int argc, char** argv) {
    drivers::exit_cleanly_on_interrupt();
    // A write past the limit of file sizes fails with a message instead.
    std::signal(SIGXFSZ, SIG_IGN);
    drivers::Command command;
    if (const auto exit_code = drivers::read_command_line(argc, argv, command)) {
        return *exit_code;
    }
    // Libraries that we stand on spin or abort where they get no memory.
    if (available_address_space() < least_memory) {
        return report(
            fmt::format("the address space of this process is limited to {} MB more (ulimit "
                        "-v), it needs {} MB to start",
                        available_address_space() >> 20U, least_memory >> 20U),
            drivers::ExitCode::run_failed, command.common.json);
    }
    if (iga::is_distributed_run() && command.name != "solve") {
        return iga::rank_of_run() != 0
                   ? drivers::ExitCode::bad_input
                   : report(fmt::format("'{}' runs in one process; of several ranks of mpirun only "
                                        "'solve' makes use",
                                        command.name),
                            drivers::ExitCode::bad_input, command.common.json);
    }
    return run_guarded(command);
}
