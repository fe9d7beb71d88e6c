#pragma once

// What the JSON of several commands of `couture rom` has in common.
#include <nlohmann/json_fwd.hpp>

#include "drivers/rom_error_measures.h"
#include "rom/parameter_space.h"

namespace couture::drivers {

/// [{"name": ..., "value": ...}, ...]
[[nodiscard]] nlohmann::ordered_json parameters_json(const rom::ParameterSpace& space,
                                                     const VectorX& point);

[[nodiscard]] nlohmann::ordered_json to_json(const PredictionErrors& errors);

}  // namespace couture::drivers
