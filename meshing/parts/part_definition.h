#pragma once

#include <functional>

#include "meshing/parts/parts.h"

namespace couture::meshing {

/// Values of all parameters of a part, checked against their ranges.
using PartValues = std::map<std::string, double>;

/// A part and how it is built.
struct PartDefinition {
    PartInfo info;
    std::function<Part(const PartValues&)> make;
};

/// @throws InputError  always: there is no `kind` called `name`; names the nearest and lists all
[[noreturn]] void throw_unknown(const std::string& who, const std::string& kind,
                                const std::string& name, const std::vector<std::string>& names);

/// The part of this name among some.
///
/// @throws InputError  for an unknown one; names the nearest and lists all
template <typename Definition>
[[nodiscard]] const Definition& find_definition(const std::string& who,
                                                const std::vector<Definition>& definitions,
                                                const std::string& name) {
    std::vector<std::string> names;
    for (const Definition& definition : definitions) {
        if (definition.info.name == name) {
            return definition;
        }
        names.push_back(definition.info.name);
    }
    throw_unknown(who, "part", name, names);
}

/// Given values, and the defaults of all other parameters.
///
/// @throws InputError  for an unknown parameter, and a value that is not finite or out of range
[[nodiscard]] PartValues complete_values(const PartInfo& info,
                                         const std::map<std::string, double>& given);

/// A length of any size.
[[nodiscard]] PartParameter length_parameter(std::string name, double value, std::string meaning);

/// @throws InputError  if values[smaller] >= values[larger]
void check_less(const std::string& part, const PartValues& values, const std::string& smaller,
                const std::string& larger);

}  // namespace couture::meshing
