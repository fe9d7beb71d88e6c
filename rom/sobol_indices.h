#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "iga/core/types.h"

namespace couture::rom {

/// A number with the ends of its confidence interval.
struct IndexEstimate {
    double value = 0.0;
    double low = 0.0;
    double high = 0.0;
};

/// What part of a function's variance its inputs cause.
struct SobolIndices {
    double mean = 0.0;
    double variance = 0.0;
    /// Of each input: by itself, and with all others that it acts together with.
    std::vector<IndexEstimate> first;
    std::vector<IndexEstimate> total;
};

struct SobolOptions {
    /// Each takes n_inputs + 2 evaluations; powers of 2 fill the cube best.
    int n_samples = 1024;
    /// Resampled estimates that the confidence intervals are made of, and their coverage.
    int n_bootstrap = 400;
    double confidence = 0.95;
    std::uint64_t seed = 1;
};

/// First-order and total indices of several functions of inputs that are independent and uniform
/// in the unit cube.
///
/// Two independent samples A and B are the halves of a Sobol sequence in 2 n_inputs dimensions;
/// A_i is A with column i of B, V the variance over A and B. Total: mean (f(A) - f(A_i))^2 / 2 V.
/// First order: mean (f(B) - f_mean) (f(A_i) - f(A)) / V, good for weak inputs, or
/// 1 - mean (f(B) - f(A_i))^2 / 2 V, good for strong ones, whichever has the narrower interval.
/// Intervals are the quantiles of the bootstrap over the samples. A function that is constant has
/// indices 0.
///
/// @param functions  values at points (n_points x n_inputs): n_points x n_functions
/// @return for each function
/// @throws InputError  without inputs, for fewer than 2 samples, values that are not finite
///
/// Source: [Saltelli10] Table 2 (b), (c), (f); the latter two after [Jansen99].
[[nodiscard]] std::vector<SobolIndices> sobol_indices(
    int n_inputs, const std::function<MatrixX(const MatrixX& points)>& functions,
    const SobolOptions& options = {});

}  // namespace couture::rom
