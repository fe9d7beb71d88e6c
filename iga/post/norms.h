#pragma once

#include <functional>

#include "iga/topology/field.h"

namespace couture::iga {

/// Exact solution at a point: value (components) and gradient (components x d).
template <int d>
struct ExactSolution {
    std::function<VectorX(const Vector3& x)> value;
    std::function<MatrixX(const Vector3& x)> gradient;
};

struct ErrorNorms {
    /// |u - u_h| and |grad u - grad u_h| in L2, and the same norms of the exact solution.
    double l2 = 0.0;
    double h1 = 0.0;
    double l2_exact = 0.0;
    double h1_exact = 0.0;
};

/// @param n_gauss_points  per direction and element; nothing: degree + 3
template <int d>
[[nodiscard]] ErrorNorms error_norms(const Field<d>& field, const ExactSolution<d>& exact,
                                     std::optional<int> n_gauss_points = {});

}  // namespace couture::iga
