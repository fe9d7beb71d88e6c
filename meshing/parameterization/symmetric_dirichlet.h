#pragma once

#include <array>

#include "iga/core/types.h"

namespace couture::meshing {

/// The energy (|F|^2 + |F^-1|^2) / 4 of a 2 x 2 matrix with positive determinant: 1 for rotations,
/// more for all others, infinite without area.
[[nodiscard]] double symmetric_dirichlet(const Matrix<2>& F);

/// Energy, gradient, and the Hessian by its eigenvectors with the negative eigenvalue raised to
/// zero.
///
/// With F = U diag(sigma) V^T the energy is that of each sigma, which is convex; the eigenvectors
/// are the two stretches and U (e1 e2^T -+ e2 e1^T) V^T / sqrt(2), of which the first one (a turn)
/// may have a negative eigenvalue.
///
/// Source: [SmithSchaefer15] (energy), [SmithDeGoesKim19] (eigenvectors of isotropic energies).
struct SymmetricDirichlet {
    double energy = 0.0;
    Matrix<2> gradient = Matrix<2>::Zero();
    /// Orthonormal in the Frobenius product.
    std::array<Matrix<2>, 4> modes;
    /// Not negative.
    std::array<double, 4> eigenvalues{};

    explicit SymmetricDirichlet(const Matrix<2>& F);
};

}  // namespace couture::meshing
