#pragma once

#include <functional>
#include <optional>

#include "drivers/commands/commands.h"

namespace couture::drivers {

/// What the command line asks for.
struct Command {
    CommonOptions common;
    std::string name;
    std::function<int()> run;
};

/// Fills `command`; the level of messages and the number of threads are set.
///
/// @return the exit code if there is nothing to run: 0 after --help or --version, 2 for a mistake,
///         which was explained on standard error
[[nodiscard]] std::optional<int> read_command_line(int argc, char** argv, Command& command);

}  // namespace couture::drivers
