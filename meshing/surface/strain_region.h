#pragma once

#include <array>
#include <optional>
#include <variant>

#include "iga/core/types.h"

namespace couture::meshing {

struct Ball {
    Vector3 center = Vector3::Zero();
    double radius = 0.0;
};

/// With sides along the axes.
struct AxisBox {
    Vector3 low = Vector3::Zero();
    Vector3 high = Vector3::Zero();
};

/// Where edges have a limit of their own.
struct StrainRegion {
    std::variant<Ball, AxisBox> shape;
    double strain_limit = 0.0;
};

/// base + r direction, r >= 0.
struct Path {
    Vector3 base = Vector3::Zero();
    Vector3 direction = Vector3::Zero();
};

/// The first and last r at which a path is in a shape; infinite for a path that stays in it.
[[nodiscard]] std::optional<std::array<double, 2>> time_inside(
    const std::variant<Ball, AxisBox>& shape, const Path& path);

[[nodiscard]] bool contains(const std::variant<Ball, AxisBox>& shape, const Vector3& point);

}  // namespace couture::meshing
