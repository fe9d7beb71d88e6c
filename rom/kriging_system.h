#pragma once

#include <mutex>

#include "rom/correlation_matrix.h"

namespace couture::rom {

/// What kriging models of different values at the same points share, if trend, lengths and nugget
/// are the same: K and the trend functions F at the points, ready for generalised least squares.
///
/// Source: [SacksWelchMitchellWynn89] Eq. (7)-(9).
class KrigingSystem {
  public:
    /// @param K  of the points, factored
    /// @param F  n_points x n_terms; columns of 0 are functions that are left out
    KrigingSystem(CorrelationMatrix K, MatrixX F);

    /// Coefficients of the trend, K^-1 (y - F beta), and the variance of the process.
    struct Fit {
        VectorX beta;
        VectorX weights;
        double variance = 0.0;
    };
    /// @param values  of the points
    [[nodiscard]] Fit fit(const VectorX& values) const;

    [[nodiscard]] const CorrelationMatrix& correlation_matrix() const { return K_; }
    /// K^-1 F, and L with L L^T = F^T K^-1 F.
    [[nodiscard]] const MatrixX& K_inverse_F() const { return K_inverse_F_; }
    [[nodiscard]] const MatrixX& trend_factor() const { return trend_factor_; }
    /// Variance of a prediction over that of the process.
    ///
    /// @param k  correlations of all points with the place
    /// @param f  trend functions there
    [[nodiscard]] double relative_variance(const VectorX& k, const VectorX& f) const;
    /// Diagonal of K^-1 - K^-1 F (F^T K^-1 F)^-1 F^T K^-1, made when first asked for.
    [[nodiscard]] const VectorX& residual_diagonal() const;

  private:
    CorrelationMatrix K_;
    MatrixX F_;
    MatrixX K_inverse_F_;
    MatrixX trend_factor_;
    mutable std::once_flag is_made_;
    mutable VectorX residual_diagonal_;
};

}  // namespace couture::rom
