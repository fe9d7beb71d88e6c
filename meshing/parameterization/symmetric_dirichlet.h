#pragma once

#include <array>

#include "iga/core/types.h"

namespace couture::meshing {

/// The energy (|F|^2 + |F^-1|^2) / 4 of a 2 x 2 matrix with positive determinant: 1 for rotations,
/// more for all others, infinite without area.
[[nodiscard]] double symmetric_dirichlet(const Matrix<2>& F);

/// Energy times w + w_area det F, gradient, and the Hessian by its eigenvectors with negative
/// eigenvalues raised to zero.
///
/// With F = U diag(s, t) V^T the eigenvectors are two combinations of the stretches U e1 e1^T V^T
/// and U e2 e2^T V^T, and U (e1 e2^T -+ e2 e1^T) V^T / sqrt(2). The energy is (s^2 + t^2 + s^-2 +
/// t^-2) / 4, times det F it is (s^3 t + s t^3 + s / t + t / s) / 4.
///
/// Source: [SmithSchaefer15] (energy), [SmithDeGoesKim19] (eigenvectors of isotropic energies).
struct SymmetricDirichlet {
    double energy = 0.0;
    Matrix<2> gradient = Matrix<2>::Zero();
    /// Orthonormal in the Frobenius product.
    std::array<Matrix<2>, 4> modes;
    /// Not negative.
    std::array<double, 4> eigenvalues{};

    explicit SymmetricDirichlet(const Matrix<2>& F, double weight = 1.0, double area_weight = 0.0);
};

}  // namespace couture::meshing
