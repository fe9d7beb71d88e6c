#pragma once

#include <filesystem>

#include "drivers/commands/commands.h"
#include "drivers/summary.h"
#include "iga/topology/multipatch.h"
#include "io/deck.h"

namespace couture::drivers {

/// What a summary says of the deck and its geometry, whatever is solved on them.
template <int d>
[[nodiscard]] Summary describe_job(const io::Deck& deck, const iga::MultiPatch<d>& geometry,
                                   const GeometryCertificate& certificate);

/// Writes the summary of a run as JSON, prints it as the options ask, and says what was not reached
/// or not met.
///
/// @return the run's exit code
/// @throws FileError  if it can't be written
[[nodiscard]] int report_run(const Summary& summary, const std::filesystem::path& json_file,
                             const CommonOptions& common);

}  // namespace couture::drivers
