#pragma once

#include <functional>

#include "iga/core/types.h"

namespace couture {

/// A number that may depend on place and time. Plane problems have z = 0; axisymmetric ones have
/// x = radius, y = axis. Must be callable from several threads at once.
using Function = std::function<double(const Vector3& x, double t)>;

[[nodiscard]] inline Function constant(double value) {
    return [value](const Vector3&, double) { return value; };
}

}  // namespace couture
