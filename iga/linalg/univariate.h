#pragma once

#include "iga/core/types.h"
#include "iga/spline/knot_vector.h"

namespace couture::iga {

/// The functions of a knot vector over the unit interval, as Kronecker products need them.
struct Univariate {
    /// Integrals of N_i' N_j' and of N_i N_j: n_basis x n_basis.
    MatrixX stiffness;
    MatrixX mass;
    /// Coefficients of xi and of xi^2 (degree 1: its interpolant), and integrals of N_i: n_basis.
    VectorX linear;
    VectorX square;
    VectorX integral;

    [[nodiscard]] int size() const { return static_cast<int>(linear.size()); }
};

[[nodiscard]] Univariate make_univariate(const KnotVector& knots);

/// One constant function: the missing third direction of a surface.
[[nodiscard]] Univariate make_constant();

/// Generalized eigenvectors of the functions first .. first + size() - 1:
/// vectors^T mass vectors = 1, vectors^T stiffness vectors = diag(values), ascending.
struct Eigenbasis {
    int first = 0;
    VectorX values;
    MatrixX vectors;

    [[nodiscard]] int size() const { return static_cast<int>(values.size()); }
};

/// @param without_first, without_last  leaves out the function that does not vanish at that end
[[nodiscard]] Eigenbasis make_eigenbasis(const Univariate& functions, bool without_first,
                                         bool without_last);

}  // namespace couture::iga
