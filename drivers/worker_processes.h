#pragma once

#include <functional>
#include <string>
#include <vector>

namespace couture::drivers {

/// Runs this program several times at once, each with arguments of its own, and waits for all.
/// They end with this process, and their messages go where its own go.
///
/// @param arguments  of each process, without the program's name
/// @param watch  called about twice a second meanwhile
/// @return their exit codes; 128 + the signal of one that was killed
/// @throws SolverError  if a process can't be started
[[nodiscard]] std::vector<int> run_processes(const std::vector<std::vector<std::string>>& arguments,
                                             const std::function<void()>& watch);

}  // namespace couture::drivers
