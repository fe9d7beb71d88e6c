#pragma once

#include <filesystem>

#include "drivers/summary.h"
#include "iga/topology/multipatch.h"
#include "io/deck.h"

namespace couture::drivers {

/// Solves a checked deck on its geometry, evaluates the probes and writes the result files into
/// `folder`.
///
/// @param phases  what was done before; the run's own are appended in the summary
/// @throws SolverError  if the matrix alone would not fit into memory (with the numbers), and all
///                      that solve_linear_static throws
template <int d>
[[nodiscard]] Summary run_linear(const io::Deck& deck, const iga::MultiPatch<d>& geometry,
                                 const std::filesystem::path& folder, std::vector<Phase> phases);

/// Bytes of one triangle of the block matrix: every function meets (2 degree + 1)^d others.
template <int d>
[[nodiscard]] double estimated_matrix_memory(const iga::MultiPatch<d>& refined, int n_components);

}  // namespace couture::drivers
