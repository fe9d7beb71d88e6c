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

/// A length of any size.
[[nodiscard]] PartParameter length_parameter(std::string name, double value, std::string meaning);

/// @throws InputError  if values[smaller] >= values[larger]
void check_less(const std::string& part, const PartValues& values, const std::string& smaller,
                const std::string& larger);

}  // namespace couture::meshing
