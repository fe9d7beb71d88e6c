#pragma once

#include <chrono>
#include <cstddef>
#include <string>
#include <vector>

namespace couture {

/// Wall clock, started at construction.
class Timer {
  public:
    [[nodiscard]] double seconds() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    }

  private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// One line of the summary.
struct Phase {
    std::string name;
    double seconds = 0.0;
    /// Highest resident memory of the process so far, bytes.
    std::size_t peak_memory = 0;
};

/// Highest resident memory of this process so far, bytes.
[[nodiscard]] std::size_t peak_memory();

/// What `ulimit -v` leaves this process, bytes.
[[nodiscard]] std::size_t available_address_space();

/// Memory that can still be had without swapping, bytes (the smallest of machine, cgroup and
/// address space).
[[nodiscard]] std::size_t available_memory();

}  // namespace couture
