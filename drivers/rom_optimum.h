#pragma once

#include <optional>

#include "drivers/rom_answer.h"
#include "rom/mass_minimum.h"

namespace couture::drivers {

/// What is asked for: the lightest member, by its geometric parameters.
struct OptimumProblem {
    rom::MassLimits limits;
    /// Loads, materials and fixed dimensions; the first start.
    VectorX point;
    /// Positions of the parameters that change.
    std::vector<int> free;
    /// Of each patch; ones if no material has a density.
    VectorX densities;
    bool has_mass = false;
};

/// @param stress_limit, displacement_limit  a number in the deck's units or with a unit; empty:
///                                          without limit
/// @param fixed  NAME=VALUE
/// @throws InputError  without a limit, for texts that are none, points outside of the box, no
///                     geometric parameter that is not fixed, some materials without a density
[[nodiscard]] OptimumProblem optimum_problem(const TrainedModel& trained,
                                             const std::string& stress_limit,
                                             const std::string& displacement_limit,
                                             const std::vector<std::string>& fixed);

[[nodiscard]] rom::MassMinimum find_optimum(const TrainedModel& trained,
                                            const OptimumProblem& problem,
                                            const rom::MassOptions& options,
                                            const std::vector<rom::SampleGrid>& grids);

/// By how much of a limit the worst value is above it; negative within the limits.
[[nodiscard]] double violation_of(const rom::MassLimits& limits, const RomExtremes& extremes);

}  // namespace couture::drivers
