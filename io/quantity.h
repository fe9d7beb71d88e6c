#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/units.h"

namespace couture::io {

/// What a probe can ask for.
struct QuantityInfo {
    enum class Place {
        point,  ///< of a field: needs a place in the body
        set,    ///< of a support: needs a named set
        whole   ///< of the body or the load case
    };

    std::string name;
    Place place;
    Dimension dimension;
};

/// All quantities of elasticity ("displacement_x", "stress_xx", "von_mises", "principal_1",
/// "volume", "reaction_x", ...) or of a Poisson problem ("potential", "flux_x", ...).
[[nodiscard]] const std::vector<QuantityInfo>& quantities(bool is_elasticity);

/// @return nothing if there is no such quantity
[[nodiscard]] std::optional<QuantityInfo> find_quantity(const std::string& name,
                                                        bool is_elasticity);

}  // namespace couture::io
