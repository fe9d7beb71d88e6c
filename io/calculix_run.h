#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "iga/core/types.h"

namespace couture::io {

/// What a run printed at its last increment.
struct CalculixResult {
    double time = 0.0;
    /// n_nodes x 3.
    MatrixX displacements;
    /// What holds the nodes, loads included: n_nodes x 3.
    MatrixX forces;
    /// Of the integration points in the undeformed body, element by element: n x 3.
    MatrixX points;
    /// Cauchy stresses there, Voigt order 11, 22, 33, 23, 13, 12: n x 6.
    MatrixX stresses;
};

/// @param file  for messages
/// @param text  a .dat file
/// @throws FileError  with file and line, unless it holds all of `CalculixResult`
[[nodiscard]] CalculixResult parse_calculix_dat(const std::string& file, std::string_view text);

/// The program `ccx`, if it is installed.
[[nodiscard]] std::optional<std::filesystem::path> find_calculix();

/// Runs `ccx` on one thread in `folder` on the input job.inp and reads its results. Its messages go
/// to job.log.
///
/// @throws FileError    if the program is not there
/// @throws SolverError  if it fails or takes longer than `time_limit`: shows the end of its output
[[nodiscard]] CalculixResult run_calculix(const std::filesystem::path& folder,
                                          const std::string& job,
                                          std::chrono::seconds time_limit = std::chrono::hours(1));

}  // namespace couture::io
