#pragma once

#include "drivers/summary.h"
#include "iga/solve/linear_static.h"
#include "iga/solve/load_stepping.h"
#include "iga/topology/locator.h"
#include "io/deck.h"

namespace couture::drivers {

/// Where each probe of the deck lies; nothing for those without a place.
///
/// @throws InputError  for a point that is farther than 1e-6 of the part's size from it: names the
///                     distance and the nearest point
template <int d>
[[nodiscard]] std::vector<std::optional<iga::Location<d>>> locate_probes(
    const io::Deck& deck, const iga::MultiPatch<d>& geometry);

/// The values of all probes. At a place that several patches share it is that of the first.
///
/// @param problem  the deck's, on the patches of the result
template <int d>
[[nodiscard]] std::vector<ProbeResult> evaluate_probes(
    const io::Deck& deck, const iga::Problem& problem,
    const std::vector<std::optional<iga::Location<d>>>& locations,
    const iga::LinearStaticResult<d>& result, double volume);

/// The label of a probe, and whether a value passes.
[[nodiscard]] ProbeResult probe_result(const io::Probe& probe, double value);

/// Value of a field quantity ("stress_xx", "displacement_magnitude", ...) at a place.
template <int d>
[[nodiscard]] double quantity_at(const iga::Problem& problem, const iga::CaseResult<d>& result,
                                 const std::string& quantity, const iga::Location<d>& location);

/// Of an accepted step at finite strain: Green-Lagrange strains, Cauchy stresses, the volume of
/// the deformed body, and what the step itself knows.
///
/// @param problem  the deck's, on the step's mesh
/// @param location  on the step's mesh, for quantities of a point
template <int d>
[[nodiscard]] double quantity_of(const io::Deck& deck, const iga::Problem& problem,
                                 const iga::AcceptedStep<d>& step, const io::Probe& probe,
                                 const std::optional<iga::Location<d>>& location);

}  // namespace couture::drivers
