#include "meshing/parts/parts.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "iga/core/error.h"
#include "iga/core/nearest_name.h"
#include "meshing/parts/annulus.h"
#include "meshing/parts/box.h"
#include "meshing/parts/cook.h"
#include "meshing/parts/cylindrical_shell.h"
#include "meshing/parts/half_seal.h"
#include "meshing/parts/hollow_sphere.h"
#include "meshing/parts/nafems.h"
#include "meshing/parts/o_grid.h"
#include "meshing/parts/pipe_tee.h"
#include "meshing/parts/plate_with_hole.h"
#include "meshing/parts/twisted_box.h"

namespace couture::meshing {

namespace {

const std::vector<PartDefinition>& definitions() {
    static const std::vector<PartDefinition> all = [] {
        std::vector<PartDefinition> list;
        for (const auto& group :
             {pipe_tee_parts, box_parts, twisted_box_parts, annulus_parts, o_grid_parts,
              plate_with_hole_parts, hollow_sphere_parts, nafems_parts, cook_parts,
              cylindrical_shell_parts, half_seal_parts}) {
            const std::vector<PartDefinition> some = group();
            list.insert(list.end(), some.begin(), some.end());
        }
        return list;
    }();
    return all;
}

}  // namespace

void throw_unknown(const std::string& who, const std::string& kind, const std::string& name,
                   const std::vector<std::string>& names) {
    const auto nearest = nearest_name(name, names);
    throw InputError("{}: unknown {} '{}'; {}there are: {}", who, kind, name,
                     nearest ? fmt::format("did you mean '{}'? ", *nearest) : "",
                     fmt::join(names, ", "));
}

PartValues complete_values(const PartInfo& info, const std::map<std::string, double>& given) {
    PartValues values;
    std::vector<std::string> names;
    for (const PartParameter& parameter : info.parameters) {
        values[parameter.name] = parameter.value;
        names.push_back(parameter.name);
    }
    for (const auto& [name, value] : given) {
        if (values.count(name) == 0) {
            throw_unknown(info.name, "parameter", name, names);
        }
        values[name] = value;
    }
    for (const PartParameter& parameter : info.parameters) {
        const double value = values[parameter.name];
        if (!(value >= parameter.min && value <= parameter.max)) {
            throw InputError("{}: {} = {} is out of range; it must lie in [{}, {}] ({})", info.name,
                             parameter.name, value, parameter.min, parameter.max,
                             parameter.meaning_and_unit);
        }
    }
    return values;
}

PartParameter length_parameter(std::string name, double value, std::string meaning) {
    constexpr double smallest = 1e-3;
    constexpr double largest = 1e5;
    return {std::move(name), value, smallest, largest, std::move(meaning)};
}

void check_less(const std::string& part, const PartValues& values, const std::string& smaller,
                const std::string& larger) {
    if (values.at(smaller) >= values.at(larger)) {
        throw InputError("{}: {} = {} is not smaller than {} = {}; make {} smaller or {} larger",
                         part, smaller, values.at(smaller), larger, values.at(larger), smaller,
                         larger);
    }
}

const std::vector<PartInfo>& parts() {
    static const std::vector<PartInfo> all = [] {
        std::vector<PartInfo> list;
        for (const PartDefinition& definition : definitions()) {
            list.push_back(definition.info);
        }
        return list;
    }();
    return all;
}

Part make_part(const std::string& name, const std::map<std::string, double>& parameters) {
    const PartDefinition& definition = find_definition("make_part", definitions(), name);
    return definition.make(complete_values(definition.info, parameters));
}

}  // namespace couture::meshing
