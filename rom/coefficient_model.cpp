#include "rom/coefficient_model.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <optional>

#include "iga/core/error.h"
#include "iga/core/parallel.h"

namespace couture::rom {

namespace {

using ArrayX = Eigen::ArrayXd;

/// Runs make(k) for all coefficients, naming the one whose model can't be made.
template <typename Make>
std::vector<Kriging> make_models(int n, const Make& make) {
    std::vector<std::optional<Kriging>> made(n);
    parallel_for(n, [&](int k) {
        try {
            made[k] = make(k);
        } catch (const InputError& error) {
            throw InputError("coefficient {}: {}", k, error.what());
        }
    });
    std::vector<Kriging> models;
    for (std::optional<Kriging>& model : made) {
        models.push_back(std::move(*model));
    }
    return models;
}

/// One for all coefficients whose parameters are the same.
std::vector<std::shared_ptr<const KrigingSystem>> make_systems(
    const TensorDesign& design, const KrigingOptions& options,
    const std::vector<KrigingParameters>& parameters) {
    const auto n = static_cast<int>(parameters.size());
    std::vector<int> first(n);
    for (int k = 0; k < n; ++k) {
        first[k] = static_cast<int>(std::find(parameters.begin(), parameters.end(), parameters[k]) -
                                    parameters.begin());
    }
    std::vector<std::shared_ptr<const KrigingSystem>> systems(n);
    parallel_for(n, [&](int k) {
        if (first[k] != k) return;
        try {
            systems[k] = make_kriging_system(design, options, parameters[k]);
        } catch (const InputError& error) {
            throw InputError("coefficient {}: {}", k, error.what());
        }
    });
    for (int k = 0; k < n; ++k) systems[k] = systems[first[k]];
    return systems;
}

/// Sum of the squares of all leave-one-out residuals of the first coefficients.
double leave_one_out_cost(const TensorDesign& design, const MatrixX& values,
                          const KrigingOptions& options) {
    constexpr Eigen::Index n_compared = 6;
    const MatrixX first = values.leftCols(std::min(n_compared, values.cols()));
    double cost = 0.0;
    for (const Kriging& model : make_models(static_cast<int>(first.cols()), [&](int k) {
             return Kriging(design, first.col(k), options);
         })) {
        cost += model.leave_one_out().squaredNorm();
    }
    return cost;
}

Trend chosen_trend(const TensorDesign& design, const MatrixX& values, KrigingOptions options) {
    if (options.trend != Trend::automatic) return options.trend;
    Trend best = Trend::constant;
    double least = std::numeric_limits<double>::infinity();
    for (const Trend trend : {Trend::constant, Trend::linear, Trend::quadratic}) {
        const int n_terms = n_trend_functions(trend, design.n_parameters());
        if (trend != Trend::constant && 2 * n_terms > values.rows()) break;
        options.trend = trend;
        const double cost = leave_one_out_cost(design, values, options);
        if (cost < least) {
            least = cost;
            best = trend;
        }
    }
    return best;
}

/// Correlations of one factor's points with a point, n_coefficients x points: as `correlations`,
/// with one exponential for all axes.
MatrixX factor_correlations(CorrelationKind kind, const MatrixX& points, const VectorX& point,
                            const MatrixX& inverse_lengths) {
    const Eigen::Index n = inverse_lengths.rows();
    MatrixX K(n, points.rows());
    ArrayX exponent(n);
    ArrayX polynomial(n);
    ArrayX s(n);
    for (Eigen::Index j = 0; j < points.rows(); ++j) {
        exponent.setZero();
        polynomial.setOnes();
        for (Eigen::Index axis = 0; axis < points.cols(); ++axis) {
            const double distance = std::abs(point[axis] - points(j, axis));
            if (kind == CorrelationKind::gaussian) {
                s = distance * inverse_lengths.col(axis).array();
                exponent += 0.5 * s * s;
            } else {
                s = (std::sqrt(5.0) * distance) * inverse_lengths.col(axis).array();
                exponent += s;
                polynomial *= 1.0 + s + s * s * (1.0 / 3.0);
            }
        }
        K.col(j) = (polynomial * (-exponent).exp()).matrix();
    }
    return K;
}

/// The same for one set of lengths, 1 x points, along the points.
MatrixX factor_correlations_of_all(CorrelationKind kind, const MatrixX& points,
                                   const VectorX& point, const VectorX& inverse_lengths) {
    ArrayX exponent = ArrayX::Zero(points.rows());
    ArrayX polynomial = ArrayX::Ones(points.rows());
    ArrayX s(points.rows());
    for (Eigen::Index axis = 0; axis < points.cols(); ++axis) {
        s = (points.col(axis).array() - point[axis]).abs() * inverse_lengths[axis];
        if (kind == CorrelationKind::gaussian) {
            exponent += 0.5 * s * s;
        } else {
            s *= std::sqrt(5.0);
            exponent += s;
            polynomial *= 1.0 + s + s * s * (1.0 / 3.0);
        }
    }
    return (polynomial * (-exponent).exp()).matrix().transpose();
}

/// Derivatives of these by one of the factor's inputs.
MatrixX factor_slopes(CorrelationKind kind, const MatrixX& points, const VectorX& point,
                      const MatrixX& inverse_lengths, Eigen::Index input, const MatrixX& K) {
    MatrixX slopes(K.rows(), K.cols());
    for (Eigen::Index j = 0; j < K.cols(); ++j) {
        for (Eigen::Index k = 0; k < K.rows(); ++k) {
            slopes(k, j) = K(k, j) * difference_derivative(kind, point[input] - points(j, input),
                                                           1.0 / inverse_lengths(k, input));
        }
    }
    return slopes;
}

/// For each coefficient the sum over all points of weight times product of the factors'
/// correlations: factor by factor from the last, which is the fastest.
VectorX contract(const std::vector<MatrixX>& factors, const MatrixX& weights) {
    MatrixX sums = weights;
    for (std::size_t g = factors.size(); g-- > 0;) {
        const MatrixX& K = factors[g];
        MatrixX shorter = MatrixX::Zero(sums.rows(), sums.cols() / K.cols());
        for (Eigen::Index i = 0; i < shorter.cols(); ++i) {
            for (Eigen::Index j = 0; j < K.cols(); ++j) {
                shorter.col(i) += K.col(j).cwiseProduct(sums.col(i * K.cols() + j));
            }
        }
        sums = std::move(shorter);
    }
    return sums.col(0);
}

/// The same where all coefficients have the factors' one row of correlations.
VectorX contract_shared(const std::vector<MatrixX>& factors, const MatrixX& weights) {
    VectorX product = VectorX::Ones(1);
    for (const MatrixX& row : factors) {
        const MatrixX outer = row.transpose() * product.transpose();
        product = Eigen::Map<const VectorX>(outer.data(), outer.size());
    }
    return weights * product;
}

}  // namespace

CoefficientModel::CoefficientModel(TensorDesign design, MatrixX values,
                                   const KrigingOptions& options)
    : design_(std::move(design)), options_(options), training_(std::move(values)) {
    if (n_inputs() > 0) {
        options_.trend = chosen_trend(design_, training_, options_);
        models_ = make_models(n_coefficients(),
                              [&](int k) { return Kriging(design_, training_.col(k), options_); });
    }
    collect();
}

CoefficientModel::CoefficientModel(TensorDesign design, MatrixX values,
                                   const KrigingOptions& options,
                                   const std::vector<KrigingParameters>& parameters)
    : design_(std::move(design)), options_(options), training_(std::move(values)) {
    if (n_inputs() > 0) {
        if (static_cast<int>(parameters.size()) != n_coefficients()) {
            throw InputError("CoefficientModel: {} kriging parameters for {} coefficients",
                             parameters.size(), n_coefficients());
        }
        const auto systems = make_systems(design_, options_, parameters);
        models_ = make_models(n_coefficients(), [&](int k) {
            return Kriging(design_, training_.col(k), options_, parameters[k], systems[k]);
        });
    }
    collect();
}

void CoefficientModel::collect() {
    if (models_.empty()) {
        if (n_coefficients() > 0 && (n_inputs() > 0 || training_.rows() != 1)) {
            throw InputError("CoefficientModel: {} values of each coefficient without an input",
                             training_.rows());
        }
        return;
    }
    const int n = n_coefficients();
    inverse_lengths_.resize(n, n_inputs());
    trends_.resize(n, models_[0].trend_coefficients().size());
    weights_.resize(n, training_.rows());
    for (int k = 0; k < n; ++k) {
        inverse_lengths_.row(k) = models_[k].parameters().lengths.cwiseInverse().transpose();
        trends_.row(k) = models_[k].trend_coefficients().transpose();
        weights_.row(k) = models_[k].weights().transpose();
    }
    is_shared_ = std::all_of(models_.begin(), models_.end(), [&](const Kriging& one) {
        return n > 1 && one.system() == models_[0].system();
    });
    if (is_shared_) inverse_lengths_.conservativeResize(1, Eigen::NoChange);
}

std::vector<KrigingParameters> CoefficientModel::parameters() const {
    std::vector<KrigingParameters> parameters;
    for (const Kriging& model : models_) {
        parameters.push_back(model.parameters());
    }
    return parameters;
}

namespace {

/// Calls body(g, points, point, inverse lengths, first input) for each factor g.
template <typename Body>
void for_factors(const TensorDesign& design, const VectorX& point, const MatrixX& inverse_lengths,
                 const Body& body) {
    Eigen::Index first = 0;
    for (std::size_t g = 0; g < design.factors.size(); ++g) {
        const Eigen::Index n = design.factors[g].cols();
        body(g, design.factors[g], point.segment(first, n), inverse_lengths.middleCols(first, n),
             first);
        first += n;
    }
}

std::vector<MatrixX> all_correlations(const TensorDesign& design, CorrelationKind kind,
                                      const VectorX& point, const MatrixX& inverse_lengths) {
    std::vector<MatrixX> factors(design.factors.size());
    for_factors(design, point, inverse_lengths,
                [&](std::size_t g, const MatrixX& points, const VectorX& x, const MatrixX& inverse,
                    Eigen::Index) {
                    factors[g] = inverse.rows() == 1
                                     ? factor_correlations_of_all(kind, points, x, inverse.row(0))
                                     : factor_correlations(kind, points, x, inverse);
                });
    return factors;
}

}  // namespace

VectorX CoefficientModel::values(const VectorX& point) const {
    assert(point.size() == n_inputs());
    if (models_.empty()) {
        return training_.rows() == 1 ? VectorX(training_.row(0)) : VectorX();
    }
    const std::vector<MatrixX> factors =
        all_correlations(design_, options_.correlation, point, inverse_lengths_);
    return trends_ * trend_functions(point.transpose(), options_.trend).transpose() +
           (is_shared_ ? contract_shared(factors, weights_) : contract(factors, weights_));
}

MatrixX CoefficientModel::gradient(const VectorX& point) const {
    assert(point.size() == n_inputs());
    if (models_.empty()) {
        return MatrixX::Zero(n_coefficients(), n_inputs());
    }
    MatrixX gradient = trends_ * trend_slopes(point, options_.trend);
    const std::vector<MatrixX> factors =
        all_correlations(design_, options_.correlation, point, inverse_lengths_);
    for_factors(design_, point, inverse_lengths_,
                [&](std::size_t g, const MatrixX& points, const VectorX& x, const MatrixX& inverse,
                    Eigen::Index first) {
                    for (Eigen::Index input = 0; input < points.cols(); ++input) {
                        std::vector<MatrixX> slopes = factors;
                        slopes[g] = factor_slopes(options_.correlation, points, x, inverse, input,
                                                  factors[g]);
                        gradient.col(first + input) += is_shared_
                                                           ? contract_shared(slopes, weights_)
                                                           : contract(slopes, weights_);
                    }
                });
    return gradient;
}

VectorX CoefficientModel::variances(const VectorX& point) const {
    assert(point.size() == n_inputs());
    VectorX variances = VectorX::Zero(n_coefficients());
    for (std::size_t k = 0; k < models_.size(); ++k) {
        const Kriging& one = models_[k];
        const auto i = static_cast<Eigen::Index>(k);
        // What variances take time for is the same where the system is.
        variances[i] =
            k > 0 && one.system() == models_[k - 1].system()
                ? variances[i - 1] / models_[k - 1].process_variance() * one.process_variance()
                : one.variance(point);
    }
    return variances;
}

MatrixX CoefficientModel::leave_one_out() const {
    MatrixX residuals = MatrixX::Zero(training_.rows(), training_.cols());
    for (std::size_t k = 0; k < models_.size(); ++k) {
        residuals.col(static_cast<Eigen::Index>(k)) = models_[k].leave_one_out();
    }
    return residuals;
}

MatrixX CoefficientModel::leave_one_out_variances() const {
    MatrixX variances = MatrixX::Zero(training_.rows(), training_.cols());
    for (std::size_t k = 0; k < models_.size(); ++k) {
        variances.col(static_cast<Eigen::Index>(k)) = models_[k].leave_one_out_variances();
    }
    return variances;
}

}  // namespace couture::rom
