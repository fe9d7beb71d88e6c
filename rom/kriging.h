#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "iga/core/types.h"
#include "rom/correlation.h"
#include "rom/kriging_system.h"
#include "rom/tensor_design.h"
#include "rom/trend.h"

namespace couture::rom {

struct KrigingOptions {
    CorrelationKind correlation = CorrelationKind::matern_5_2;
    /// Automatic: in CoefficientModel only.
    Trend trend = Trend::constant;
    /// Variance of noise over that of the process; without it by maximum likelihood.
    std::optional<double> nugget = std::nullopt;
    /// Searches for the largest likelihood, from different lengths.
    int n_starts = 4;
    std::uint64_t seed = 1;
};

/// What a model expects at a point.
struct Prediction {
    double value = 0.0;
    /// Of the value, without noise.
    double variance = 0.0;
    /// d value / d point.
    VectorX gradient;
};

/// Correlation lengths and nugget with the logarithm of their likelihood.
struct KrigingParameters {
    /// One for each input.
    VectorX lengths;
    double nugget = 0.0;

    [[nodiscard]] bool operator==(const KrigingParameters&) const = default;
};

/// Minus the logarithm of the likelihood of values, trend and variance eliminated, without its
/// constant: n / 2 log(variance) + log(det K) / 2.
///
/// @param log_parameters  logarithms of the lengths, then of the nugget if `options` leave it open
/// @param gradient  with respect to these
/// @return infinity if K is not positive definite
///
/// Source: [SacksWelchMitchellWynn89] Sec. 4.
[[nodiscard]] double kriging_objective(const TensorDesign& design, const VectorX& values,
                                       const KrigingOptions& options, const VectorX& log_parameters,
                                       VectorX& gradient);

/// Lengths and nugget at which the product of the likelihoods of several coefficients, each with a
/// variance and a trend of its own, is largest.
///
/// @param values  n_points x n_coefficients
/// @throws InputError  if points coincide and there is no nugget
[[nodiscard]] KrigingParameters most_likely_parameters(const TensorDesign& design,
                                                       const MatrixX& values,
                                                       const KrigingOptions& options);

/// K of the points of a design, and the trend there, factored.
///
/// @throws InputError  if K is singular
[[nodiscard]] std::shared_ptr<const KrigingSystem> make_kriging_system(
    const TensorDesign& design, const KrigingOptions& options, const KrigingParameters& parameters);

/// A Gaussian process through values at the points of a design in the unit cube: trend and
/// variance by generalised least squares, lengths and nugget by maximum likelihood. Designs that
/// are tensor products cost what their factors cost.
///
/// Source: [SacksWelchMitchellWynn89] Eq. (7)-(9).
class Kriging {
  public:
    /// @param values  of all points of the design, in their order
    /// @throws InputError  for another number of values, values that are not finite, fewer points
    ///                     than the trend has terms, points that coincide without a nugget
    Kriging(TensorDesign design, const VectorX& values, const KrigingOptions& options = {});
    /// With parameters that are known, e.g. from a file.
    Kriging(TensorDesign design, const VectorX& values, const KrigingOptions& options,
            KrigingParameters parameters);
    /// With what models of other values at these points have made already.
    Kriging(TensorDesign design, const VectorX& values, const KrigingOptions& options,
            KrigingParameters parameters, std::shared_ptr<const KrigingSystem> system);

    [[nodiscard]] const KrigingParameters& parameters() const { return parameters_; }
    /// K^-1 (y - trend), one for each point of the design.
    [[nodiscard]] const VectorX& weights() const { return weights_; }
    /// Of `trend_functions`.
    [[nodiscard]] const VectorX& trend_coefficients() const { return beta_; }
    /// Of the process, that correlations multiply.
    [[nodiscard]] double process_variance() const { return variance_; }
    /// What variances are made of; one object for all models that share it.
    [[nodiscard]] const std::shared_ptr<const KrigingSystem>& system() const { return system_; }
    /// @param point  n_parameters values; outside the unit cube it extrapolates
    [[nodiscard]] Prediction predict(const VectorX& point) const;
    /// predict(point).value at little cost.
    [[nodiscard]] double value(const VectorX& point) const;
    /// predict(point).variance without its gradient.
    [[nodiscard]] double variance(const VectorX& point) const;
    /// Value at each point minus its prediction from all others with the same parameters.
    ///
    /// Source: [Dubrule83] Eq. (8).
    [[nodiscard]] VectorX leave_one_out() const;
    /// Variances that these residuals should have.
    [[nodiscard]] VectorX leave_one_out_variances() const;

  private:
    void fit(const VectorX& values);
    /// @param k  correlations of all points with the point
    [[nodiscard]] double variance(const VectorX& k, const VectorX& point) const;
    /// For each factor its points' correlations with a point.
    [[nodiscard]] std::vector<MatrixX> correlations_with(const VectorX& point) const;

    TensorDesign design_;
    KrigingOptions options_;
    KrigingParameters parameters_;
    std::shared_ptr<const KrigingSystem> system_;
    VectorX beta_;
    VectorX weights_;
    double variance_ = 0.0;
};

}  // namespace couture::rom
