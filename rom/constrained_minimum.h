#pragma once

#include <functional>

#include "iga/core/types.h"

namespace couture::rom {

struct ConstrainedMinimum {
    VectorX x;
    double value = 0.0;
    /// The largest of the constraints' values; at most the tolerance if x is feasible.
    double violation = 0.0;
    int n_evaluations = 0;
};

/// A function, then its constraints, at x; writes their gradients into columns.
using ConstrainedFunction = std::function<VectorX(const VectorX& x, MatrixX& gradients)>;

/// A local minimum of the first function within bounds where the others are at most 0, from a
/// start, by sequential quadratic programming. Where nothing feasible is found the point with the
/// least violation.
///
/// @param functions  1 + n_constraints values and n x (1 + n_constraints) gradients, of order 1
/// @param start, lower, upper  n values; the start is moved between the bounds
/// @param tolerance  of the constraints
/// @throws SolverError  if a function is not finite at the start
///
/// Source: [Kraft88]; the library NLopt.
[[nodiscard]] ConstrainedMinimum constrained_minimum(const ConstrainedFunction& functions,
                                                     const VectorX& start, const VectorX& lower,
                                                     const VectorX& upper, double tolerance);

}  // namespace couture::rom
