#pragma once

#include <string>

#include "iga/core/types.h"

namespace couture::rom {

/// Polynomials whose sum is the mean of a kriging model.
enum class Trend {
    constant,
    linear,
    quadratic,  ///< with all products of two inputs
    automatic   ///< of these the one with the least leave-one-out errors: CoefficientModel
};

[[nodiscard]] std::string to_string(Trend trend);

/// Number of the functions: 1, then d inputs, then d (d + 1) / 2 products.
[[nodiscard]] int n_trend_functions(Trend trend, int n_inputs);

/// Functions 1, x_i, x_i x_j (j >= i, by i) at points: n_points x n_functions.
///
/// @param points  n_points x n_inputs
/// @param trend   not automatic
[[nodiscard]] MatrixX trend_functions(const MatrixX& points, Trend trend);

/// The functions at the points of a design: those that are combinations of the ones before there,
/// such as products of inputs that never vary together, are 0.
[[nodiscard]] MatrixX independent_trend(const MatrixX& points, Trend trend);

/// Number of those that are not.
[[nodiscard]] int n_independent_terms(const MatrixX& points, Trend trend);

/// Derivatives of all functions at a point: n_functions x n_inputs.
[[nodiscard]] MatrixX trend_slopes(const VectorX& point, Trend trend);

}  // namespace couture::rom
