#include "io/quantity.h"

#include <algorithm>

namespace couture::io {

namespace {

using Place = QuantityInfo::Place;

void add_vector(std::vector<QuantityInfo>& list, const std::string& name, Place place,
                const Dimension& dimension) {
    for (const char* axis : {"x", "y", "z"}) {
        list.push_back({name + "_" + axis, place, dimension});
    }
}

std::vector<QuantityInfo> elastic_quantities() {
    std::vector<QuantityInfo> list;
    add_vector(list, "displacement", Place::point, dimensions::length);
    list.push_back({"displacement_magnitude", Place::point, dimensions::length});
    for (const char* component : {"xx", "yy", "zz", "yz", "xz", "xy"}) {
        list.push_back({std::string("stress_") + component, Place::point, dimensions::pressure});
    }
    list.push_back({"von_mises", Place::point, dimensions::pressure});
    for (const char* number : {"1", "2", "3"}) {
        list.push_back({std::string("principal_") + number, Place::point, dimensions::pressure});
    }
    for (const char* component : {"xx", "yy", "zz", "yz", "xz", "xy"}) {
        list.push_back({std::string("strain_") + component, Place::point, dimensions::none});
    }
    add_vector(list, "reaction", Place::set, dimensions::force);
    add_vector(list, "applied_force", Place::whole, dimensions::force);
    list.push_back({"volume", Place::whole, dimensions::volume});
    list.push_back({"energy", Place::whole, dimensions::moment});
    return list;
}

std::vector<QuantityInfo> poisson_quantities() {
    std::vector<QuantityInfo> list;
    list.push_back({"potential", Place::point, dimensions::temperature});
    add_vector(list, "flux", Place::point, dimensions::heat_flux);
    list.push_back({"volume", Place::whole, dimensions::volume});
    list.push_back({"energy", Place::whole, dimensions::none});
    return list;
}

}  // namespace

const std::vector<QuantityInfo>& quantities(bool is_elasticity) {
    static const std::vector<QuantityInfo> elastic = elastic_quantities();
    static const std::vector<QuantityInfo> poisson = poisson_quantities();
    return is_elasticity ? elastic : poisson;
}

std::optional<QuantityInfo> find_quantity(const std::string& name, bool is_elasticity) {
    const auto& list = quantities(is_elasticity);
    const auto found = std::find_if(list.begin(), list.end(),
                                    [&](const QuantityInfo& info) { return info.name == name; });
    return found == list.end() ? std::nullopt : std::optional(*found);
}

}  // namespace couture::io
