#pragma once

#include <string>
#include <vector>

namespace couture::drivers {

/// One solution of the pipe tee (twelve rational patches) by `mpirun`, to 1e-8, without files.
struct RankRow {
    /// "strong": one problem on more ranks; "weak": about as many unknowns for each.
    std::string task;
    std::string solver;
    int degree = 0;
    int n_elements = 0;
    int n_ranks = 1;
    int n_unknowns = 0;
    double assembly_seconds = 0.0;
    double setup_seconds = 0.0;
    double solve_seconds = 0.0;
    int iterations = 0;
    /// Of the rank that has most: unknowns owned, ranks it shares functions with, bytes sent in one
    /// product, highest resident memory.
    double unknowns_of_rank = 0.0;
    double neighbours = 0.0;
    double bytes_sent = 0.0;
    double peak_memory = 0.0;
};

/// Empty, with a message, where there is no `mpirun`. More ranks than cores are started all the
/// same: their times say nothing, what they hold and send does.
///
/// @throws SolverError  if a run fails: its last message
[[nodiscard]] std::vector<RankRow> measure_ranks(bool quick);
[[nodiscard]] std::string ranks_text(const std::vector<RankRow>& rows);

}  // namespace couture::drivers
