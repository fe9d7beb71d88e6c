#include "rom/parameter_space.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "iga/core/error.h"
#include "iga/core/nearest_name.h"

namespace couture::rom {

namespace {

std::vector<std::string> names_of(const std::vector<Parameter>& parameters) {
    std::vector<std::string> names;
    for (const Parameter& parameter : parameters) {
        names.push_back(parameter.name);
    }
    return names;
}

void check(const std::vector<Parameter>& parameters) {
    if (parameters.empty()) {
        throw InputError("ParameterSpace: no parameters; a reduced model needs at least one");
    }
    std::vector<std::string> names = names_of(parameters);
    std::sort(names.begin(), names.end());
    const auto twice = std::adjacent_find(names.begin(), names.end());
    if (twice != names.end()) {
        throw InputError("ParameterSpace: two parameters are called '{}'; names must differ",
                         *twice);
    }
    for (const Parameter& parameter : parameters) {
        if (!(std::isfinite(parameter.lower) && std::isfinite(parameter.upper) &&
              parameter.lower < parameter.upper)) {
            throw InputError(
                "ParameterSpace: range [{}, {}] of '{}'; the lower end must be below the upper, "
                "both finite; leave the parameter out if it is fixed",
                parameter.lower, parameter.upper, parameter.name);
        }
        if (parameter.is_periodic && parameter.group != ParameterGroup::geometry) {
            throw InputError(
                "ParameterSpace: '{}' is periodic; only parameters of the geometry can be",
                parameter.name);
        }
    }
}

}  // namespace

ParameterSpace::ParameterSpace(std::vector<Parameter> parameters)
    : parameters_(std::move(parameters)), lower_(size()), extent_(size()) {
    check(parameters_);
    for (int i = 0; i < size(); ++i) {
        lower_[i] = parameters_[i].lower;
        extent_[i] = parameters_[i].upper - parameters_[i].lower;
    }
}

int ParameterSpace::index_of(const std::string& name) const {
    for (int i = 0; i < size(); ++i) {
        if (parameters_[i].name == name) {
            return i;
        }
    }
    throw InputError("ParameterSpace: no parameter is called '{}'; did you mean '{}'?", name,
                     *nearest_name(name, names_of(parameters_)));
}

std::vector<int> ParameterSpace::group(ParameterGroup group) const {
    std::vector<int> positions;
    for (int i = 0; i < size(); ++i) {
        if (parameters_[i].group == group) {
            positions.push_back(i);
        }
    }
    return positions;
}

VectorX ParameterSpace::centre() const { return from_unit(VectorX::Constant(size(), 0.5)); }

VectorX ParameterSpace::to_unit(const VectorX& point) const {
    assert(point.size() == size());
    return (point - lower_).cwiseQuotient(extent_);
}

VectorX ParameterSpace::from_unit(const VectorX& unit_point) const {
    assert(unit_point.size() == size());
    return lower_ + unit_point.cwiseProduct(extent_);
}

double ParameterSpace::distance_outside(const VectorX& point) const {
    const VectorX unit = to_unit(point);
    double distance = 0.0;
    for (int i = 0; i < size(); ++i) {
        if (parameters_[i].is_periodic) continue;
        distance = std::max({distance, -unit[i], unit[i] - 1.0});
    }
    return distance;
}

}  // namespace couture::rom
