#pragma once

#include "iga/core/types.h"

namespace couture::rom {

enum class CorrelationKind { matern_5_2, gaussian };

/// Correlation of two values at a distance on one axis; that of points is the product over axes.
///
/// matern_5_2: (1 + s + s^2 / 3) exp(-s), s = sqrt(5) |x - y| / length; gaussian:
/// exp(-((x - y) / length)^2 / 2).
///
/// Source: [RasmussenWilliams06] Eq. (4.9), (4.17).
[[nodiscard]] double correlation(CorrelationKind kind, double difference, double length);

/// d correlation / d difference, over the correlation.
[[nodiscard]] double difference_derivative(CorrelationKind kind, double difference, double length);

/// Products over axes between points and points.
///
/// @param a  n x d
/// @param b  m x d
/// @param lengths  of the d axes, positive
/// @return n x m
[[nodiscard]] MatrixX correlations(CorrelationKind kind, const MatrixX& a, const MatrixX& b,
                                   const VectorX& lengths);

/// For each axis the sum over all pairs of points of weight times d log(correlation) / d
/// log(length).
///
/// @param points   n x d
/// @param weights  n x n, symmetric
[[nodiscard]] VectorX log_length_derivatives(CorrelationKind kind, const MatrixX& points,
                                             const VectorX& lengths, const MatrixX& weights);

}  // namespace couture::rom
