#pragma once

#include <filesystem>

#include "drivers/deck_check.h"
#include "drivers/summary.h"
#include "iga/topology/multipatch.h"
#include "io/deck.h"

namespace couture::drivers {

/// Solves a checked deck on its geometry, evaluates the probes and writes the result files into
/// `folder`.
///
/// @param phases  what was done before; the run's own are appended in the summary
/// @throws  all that make_space and solve_linear_static throw
template <int d>
[[nodiscard]] Summary run_linear(const io::Deck& deck, const iga::MultiPatch<d>& geometry,
                                 const GeometryCertificate& certificate,
                                 const std::filesystem::path& folder, std::vector<Phase> phases);

}  // namespace couture::drivers
