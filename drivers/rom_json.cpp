#include "drivers/rom_json.h"

#include <nlohmann/json.hpp>

namespace couture::drivers {

nlohmann::ordered_json parameters_json(const rom::ParameterSpace& space, const VectorX& point) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (int i = 0; i < space.size(); ++i) {
        list.push_back({{"name", space.parameters()[i].name}, {"value", point[i]}});
    }
    return list;
}

nlohmann::ordered_json to_json(const PredictionErrors& errors) {
    return {{"displacement", errors.displacement}, {"displacement_max", errors.displacement_max},
            {"geometry", errors.geometry},         {"geometry_max", errors.geometry_max},
            {"von_mises", errors.von_mises},       {"von_mises_max", errors.von_mises_max}};
}

}  // namespace couture::drivers
