#pragma once

#include <filesystem>

#include "drivers/deck_check.h"
#include "drivers/summary.h"
#include "iga/topology/multipatch.h"
#include "io/deck.h"
#include "io/state_file.h"

namespace couture::drivers {

/// Follows a checked hyperelastic deck in time. Each accepted step writes its fields and its state
/// ("states/0001.h5", ...) into `folder` and lists them in "<name>.pvd", each file whole or not at
/// all. A run that does not reach its end says so in the summary; all its steps stay.
///
/// @param resume  goes on from the newest state in `folder`, else these are removed
/// @param phases  what was done before; the run's own are appended in the summary
/// @throws SolverError  if a file of a step can't be written: says what is kept
/// @throws InputError   for states of another deck, and what follow_loads and make_space throw
template <int d>
[[nodiscard]] Summary run_stepped(const io::Deck& deck, const iga::MultiPatch<d>& geometry,
                                  const GeometryCertificate& certificate,
                                  const std::filesystem::path& folder, bool resume,
                                  std::vector<Phase> phases);

/// What the states of a deck's run have in common.
[[nodiscard]] io::StateOrigin state_origin(const io::Deck& deck, const std::string& signature);

template <int d>
[[nodiscard]] StepSummary to_summary(const iga::AcceptedStep<d>& step);

}  // namespace couture::drivers
