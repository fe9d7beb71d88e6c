#pragma once

#include <functional>

#include "iga/core/types.h"

namespace couture::rom {

struct BoundedMinimum {
    VectorX x;
    double value = 0.0;
};

/// A local minimum within bounds by L-BFGS, from a start.
///
/// @param function  value at x; writes its gradient
/// @param start, lower, upper  n values; the start is moved between the bounds
/// @param tolerance  ends when a step changes the value by less
/// @throws SolverError  if the function is not finite at the start
///
/// Source: [Nocedal80]; the library NLopt.
[[nodiscard]] BoundedMinimum bounded_minimum(
    const std::function<double(const VectorX& x, VectorX& gradient)>& function,
    const VectorX& start, const VectorX& lower, const VectorX& upper, double tolerance);

}  // namespace couture::rom
