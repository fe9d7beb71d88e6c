#pragma once

#include <optional>
#include <vector>

#include "iga/core/types.h"

namespace couture::rom {

/// K = K_1 x K_2 x ... + nugget I, a Kronecker product of symmetric matrices, factored.
///
/// One factor is factored by Cholesky's method, several by their eigenvectors: cost and memory are
/// those of the factors, sum n_g^3 instead of (prod n_g)^3.
///
/// Source: [Saatci11] Ch. 5 (products with a nugget through eigenvectors).
class CorrelationMatrix {
  public:
    /// @param has_slopes  keeps what `likelihood_slope` takes: most of the time of one factor
    /// @return nothing if K is not positive definite to rounding
    [[nodiscard]] static std::optional<CorrelationMatrix> factored(std::vector<MatrixX> factors,
                                                                   double nugget,
                                                                   bool has_slopes = false);

    /// Of one factor: lower, L L^T = K; empty for several.
    [[nodiscard]] const MatrixX& cholesky_factor() const { return L_; }
    /// Of several: eigenvectors of each, and the eigenvalues of K, the last factor fastest; empty
    /// for one.
    [[nodiscard]] const std::vector<MatrixX>& eigenvectors() const { return eigenvectors_; }
    [[nodiscard]] const VectorX& eigenvalues() const { return eigenvalues_; }

    /// K^-1 B. @param B  n x m, rows with the last factor fastest
    [[nodiscard]] MatrixX solve(const MatrixX& B) const;
    [[nodiscard]] double log_determinant() const;
    /// Diagonal of K^-1.
    [[nodiscard]] VectorX inverse_diagonal() const;
    /// Derivative of (log(det K) + y^T K^-1 y / variance) / 2 by the entries of K_g: S with
    /// d = sum of S_ij dK_ij for symmetric dK, n_g x n_g. Only if it was factored for slopes.
    ///
    /// @param w  K^-1 y
    [[nodiscard]] MatrixX likelihood_slope(int i_factor, const VectorX& w, double variance) const;

  private:
    CorrelationMatrix() = default;
    [[nodiscard]] bool factor(bool has_slopes);

    std::vector<MatrixX> factors_;
    double nugget_ = 0.0;
    std::vector<int> sizes_;
    /// Of one factor: lower Cholesky factor of K, and for slopes K^-1.
    MatrixX L_;
    MatrixX inverse_;
    /// Of several: eigenvectors of each, and the eigenvalues of K, the last factor fastest.
    std::vector<MatrixX> eigenvectors_;
    std::vector<VectorX> factor_eigenvalues_;
    VectorX eigenvalues_;
};

/// Rows i_1, ..., i_g, ... of B combined along factor g by A: the product (I x ... A ... x I) B.
///
/// @param A  m x n_g; @param sizes  n_1, n_2, ...; @param B  prod n_g rows
[[nodiscard]] MatrixX apply_along(const MatrixX& A, int i_factor, const std::vector<int>& sizes,
                                  const MatrixX& B);

/// (A_1 x A_2 x ...) B for square matrices.
[[nodiscard]] MatrixX apply_kronecker(const std::vector<MatrixX>& A, const MatrixX& B);

}  // namespace couture::rom
