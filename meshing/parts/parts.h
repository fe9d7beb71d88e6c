#pragma once

#include <map>
#include <string>
#include <variant>
#include <vector>

#include "iga/topology/multipatch.h"

namespace couture::meshing {

/// A dimension of a part.
struct PartParameter {
    std::string name;
    /// Default.
    double value = 0.0;
    double min = 0.0;
    double max = 0.0;
    std::string meaning_and_unit;
};

/// What there is to know of a part before it is built.
struct PartInfo {
    std::string name;
    /// Shape, position and named boundary sets.
    std::string description;
    std::vector<PartParameter> parameters;
    /// 2: surface patches in the plane, 3: volumes.
    int dimension = 3;
};

using Part = std::variant<iga::MultiPatch<2>, iga::MultiPatch<3>>;

/// All hand-laid spline parts, in the order of `README.md`.
[[nodiscard]] const std::vector<PartInfo>& parts();

/// Builds a part: exact splines, right-handed patches, interfaces and named boundary sets.
///
/// @param parameters  by name; those left out take their defaults. Lengths in any one unit.
/// @throws InputError  for an unknown part or parameter (names the nearest and lists all), a value
///                     that is not finite or out of range, and values that contradict each other
[[nodiscard]] Part make_part(const std::string& name,
                             const std::map<std::string, double>& parameters = {});

}  // namespace couture::meshing
