#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "iga/core/types.h"

namespace couture::iga {

/// The processes ("ranks") that `mpirun` started, this one among them. All calls but `rank`, `size`
/// and `abort` are collective: every rank makes them, in the same order.
class Communicator {
  public:
    /// All ranks; starts MPI at the first call.
    Communicator();

    [[nodiscard]] int rank() const { return rank_; }
    [[nodiscard]] int size() const { return size_; }
    /// Ranks on this machine.
    [[nodiscard]] int size_here() const;

    [[nodiscard]] MatrixX sum(const MatrixX& values) const;
    [[nodiscard]] double sum(double value) const;
    [[nodiscard]] std::int64_t sum(std::int64_t value) const;
    [[nodiscard]] double max(double value) const;
    /// Sum of the values of all ranks before this one.
    [[nodiscard]] std::int64_t sum_before(std::int64_t value) const;
    /// The value of each rank.
    [[nodiscard]] std::vector<double> gather(double value) const;
    /// Text of one rank on all.
    [[nodiscard]] std::string from(int rank, const std::string& text) const;
    /// Sends a list to each rank, returns what each sent to this one.
    [[nodiscard]] std::vector<std::vector<std::int64_t>> exchange(
        const std::vector<std::vector<std::int64_t>>& to) const;

    /// Runs a body that makes no collective call. If it throws on any rank, all ranks throw the
    /// error of the first of those.
    void together(const std::function<void()>& body) const;

    /// After an error that this rank alone may have met, out of a collective call: returns if all
    /// ranks come here within `seconds`; else the others wait for this one in vain: the message is
    /// printed and the whole run is ended with `exit_code`.
    void end_unless_all_failed(const std::string& message, int exit_code,
                               double seconds = 5.0) const;

  private:
    int rank_ = 0;
    int size_ = 1;
};

/// True if this process was started by `mpirun` or `srun` with others beside it.
[[nodiscard]] bool is_distributed_run();
/// What it told this process of its rank; MPI is not started.
[[nodiscard]] int rank_of_run();

}  // namespace couture::iga
