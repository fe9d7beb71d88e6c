#pragma once

#include <map>
#include <string>
#include <vector>

#include "iga/core/types.h"

namespace couture::meshing {

enum class DimensionKind {
    length,
    radius,
    diameter,
    /// How far a cap is moved; may be negative.
    displacement
};

/// What lies at an end of a dimension.
enum class DimensionEnd {
    surface,
    /// The axis of a cylinder or torus.
    axis,
    /// The centre of a cap that is not moved.
    unmoved_cap
};

/// What a size of a part measures, and how a drawing shows it.
struct PartDimension {
    /// Name; empty for a size that is fixed.
    std::string parameter;
    /// mm.
    double value = 0.0;
    DimensionKind kind = DimensionKind::length;
    Vector3 from = Vector3::Zero();
    Vector3 to = Vector3::Zero();
    DimensionEnd from_end = DimensionEnd::surface;
    DimensionEnd to_end = DimensionEnd::surface;
    /// Unit direction that is measured along.
    Vector3 along = Vector3::UnitX();
    /// Unit direction, across `along`, in which the dimension line is moved out of the part; zero:
    /// the line goes through both ends, in a plane across z.
    Vector3 offset = Vector3::Zero();
};

/// The distance of the ends along the measured direction, with its sign.
[[nodiscard]] double measured_distance(const PartDimension& dimension);

/// What each parameter of a part as a surface measures, at least one dimension for each, and the
/// main sizes that are fixed.
///
/// @param parameters  by name; those left out take their defaults. mm.
/// @throws InputError  for an unknown part or parameter (names the nearest and lists all), and a
///                     value that is not finite or out of range
[[nodiscard]] std::vector<PartDimension> part_dimensions(
    const std::string& name, const std::map<std::string, double>& parameters = {});

}  // namespace couture::meshing
