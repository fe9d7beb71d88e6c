#include "meshing/surface/strain_region.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace couture::meshing {

namespace {

using Interval = std::array<double, 2>;
constexpr double infinity = std::numeric_limits<double>::infinity();

std::optional<Interval> inside(const Ball& ball, const Path& path) {
    const Vector3 offset = path.base - ball.center;
    const double a = path.direction.squaredNorm();
    const double b = path.direction.dot(offset);
    const double c = offset.squaredNorm() - ball.radius * ball.radius;
    if (!(a > 0.0)) return c <= 0.0 ? std::optional(Interval{-infinity, infinity}) : std::nullopt;
    const double discriminant = b * b - a * c;
    if (discriminant < 0.0) return {};
    const double root = std::sqrt(discriminant);
    return Interval{(-b - root) / a, (-b + root) / a};
}

std::optional<Interval> inside(const AxisBox& box, const Path& path) {
    Interval interval{-infinity, infinity};
    for (int axis = 0; axis < 3; ++axis) {
        const double to_low = box.low[axis] - path.base[axis];
        const double to_high = box.high[axis] - path.base[axis];
        if (path.direction[axis] == 0.0) {
            if (to_low > 0.0 || to_high < 0.0) return {};
            continue;
        }
        const double a = to_low / path.direction[axis];
        const double b = to_high / path.direction[axis];
        interval = {std::max(interval[0], std::min(a, b)), std::min(interval[1], std::max(a, b))};
    }
    return interval[0] <= interval[1] ? std::optional(interval) : std::nullopt;
}

}  // namespace

std::optional<Interval> time_inside(const std::variant<Ball, AxisBox>& shape, const Path& path) {
    return std::visit([&](const auto& one) { return inside(one, path); }, shape);
}

bool contains(const std::variant<Ball, AxisBox>& shape, const Vector3& point) {
    // A path that stays where it is.
    return time_inside(shape, {point, Vector3::Zero()}).has_value();
}

}  // namespace couture::meshing
