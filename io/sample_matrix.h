#pragma once

#include <vector>

#include "iga/spline/knot_vector.h"

namespace couture::io {

/// Parameters that cut each span between `breakpoints` into `samples` equal parts, ends included:
/// n_elements * samples + 1 of them.
[[nodiscard]] std::vector<double> sample_parameters(const std::vector<double>& breakpoints,
                                                    int samples);

/// Values of all functions at `parameters`: parameters x n_basis.
///
/// @throws InputError  if a parameter lies outside the knots
[[nodiscard]] SparseMatrix sample_matrix(const iga::KnotVector& knots,
                                         const std::vector<double>& parameters);

}  // namespace couture::io
