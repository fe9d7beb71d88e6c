#pragma once

#include <vector>

#include "rom/kriging.h"

namespace couture::rom {

/// Kriging models of several coefficients with values at the points of one design, evaluated
/// together. Without inputs (a design without factors) it holds constants.
class CoefficientModel {
  public:
    /// An automatic trend becomes that with which leaving out one point costs the first
    /// coefficients least, of those with at most half as many terms as there are points.
    ///
    /// @param values  n_points x n_coefficients, the largest coefficients first
    /// @throws InputError  as Kriging, naming the coefficient
    CoefficientModel(TensorDesign design, MatrixX values, const KrigingOptions& options);
    /// With parameters that are known, one for each coefficient. Where they are the same the
    /// correlation matrix is factored once.
    CoefficientModel(TensorDesign design, MatrixX values, const KrigingOptions& options,
                     const std::vector<KrigingParameters>& parameters);

    [[nodiscard]] int n_coefficients() const { return static_cast<int>(training_.cols()); }
    [[nodiscard]] int n_inputs() const { return design_.n_parameters(); }
    [[nodiscard]] const TensorDesign& design() const { return design_; }
    [[nodiscard]] const KrigingOptions& options() const { return options_; }
    /// Those learned from, n_points x n_coefficients.
    [[nodiscard]] const MatrixX& training() const { return training_; }
    [[nodiscard]] std::vector<KrigingParameters> parameters() const;
    /// Of each coefficient; none without inputs.
    [[nodiscard]] const std::vector<Kriging>& models() const { return models_; }

    /// All coefficients at a point. @param point  n_inputs values, in the unit cube where learned
    [[nodiscard]] VectorX values(const VectorX& point) const;
    /// d values / d point: n_coefficients x n_inputs.
    [[nodiscard]] MatrixX gradient(const VectorX& point) const;
    /// Variances of the values.
    [[nodiscard]] VectorX variances(const VectorX& point) const;
    /// As Kriging::leave_one_out, and the variances expected: n_points x n_coefficients.
    [[nodiscard]] MatrixX leave_one_out() const;
    [[nodiscard]] MatrixX leave_one_out_variances() const;

  private:
    void collect();

    TensorDesign design_;
    KrigingOptions options_;
    MatrixX training_;
    std::vector<Kriging> models_;
    /// All models have the same lengths and nugget.
    bool is_shared_ = false;
    /// Coefficients run along the columns, so that all are computed side by side.
    MatrixX inverse_lengths_;  ///< n_coefficients x n_inputs; 1 x n_inputs if shared
    MatrixX trends_;           ///< n_coefficients x trend terms
    MatrixX weights_;          ///< n_coefficients x n_points
};

}  // namespace couture::rom
