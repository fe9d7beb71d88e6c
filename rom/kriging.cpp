#include "rom/kriging.h"

#include <cassert>
#include <cmath>
#include <limits>

#include "iga/core/error.h"
#include "rom/bounded_minimum.h"
#include "rom/designs.h"

namespace couture::rom {

namespace {

/// Of the unit cube's edge. Longer ones don't differ from a polynomial, shorter ones from noise.
constexpr double shortest_length = 0.05;
constexpr double longest_length = 20.0;
/// Parameters whose logarithms of the likelihood differ by less are as good.
constexpr double same_likelihood = 1e-7;
constexpr double least_nugget = 1e-10;
constexpr double largest_nugget = 1.0;
/// First input of each factor.
std::vector<int> offsets(const TensorDesign& design) {
    std::vector<int> first;
    int n = 0;
    for (const MatrixX& factor : design.factors) {
        first.push_back(n);
        n += static_cast<int>(factor.cols());
    }
    return first;
}

std::vector<MatrixX> correlation_factors(const TensorDesign& design, CorrelationKind kind,
                                         const VectorX& lengths) {
    const std::vector<int> first = offsets(design);
    std::vector<MatrixX> factors;
    for (std::size_t g = 0; g < design.factors.size(); ++g) {
        const MatrixX& points = design.factors[g];
        factors.push_back(
            correlations(kind, points, points, lengths.segment(first[g], points.cols())));
    }
    return factors;
}

KrigingParameters to_parameters(const VectorX& logarithms, int n_inputs,
                                const KrigingOptions& options) {
    return {logarithms.head(n_inputs).array().exp(),
            options.nugget ? *options.nugget : std::exp(logarithms[n_inputs])};
}

void check(const TensorDesign& design, const VectorX& values, const KrigingOptions& options) {
    if (design.factors.empty() || values.size() != design.n_points()) {
        throw InputError("Kriging: {} values for a design of {} points; there must be one for each",
                         values.size(), design.factors.empty() ? 0 : design.n_points());
    }
    if (!values.allFinite()) {
        throw InputError("Kriging: a value is not finite; leave its point out");
    }
    const int n_terms = n_independent_terms(design.points(), options.trend);
    if (values.size() <= n_terms) {
        throw InputError("Kriging: {} points; a trend of {} terms needs at least {}", values.size(),
                         n_terms, n_terms + 1);
    }
    if (options.n_starts < 1 || (options.nugget && !(*options.nugget >= 0.0))) {
        throw InputError(
            "Kriging: {} starts, nugget {}; there must be at least 1, and no less "
            "than 0",
            options.n_starts, options.nugget.value_or(0.0));
    }
}

/// Bounds of the logarithms of lengths and nugget.
struct Bounds {
    VectorX lower;
    VectorX upper;
};

/// Long lengths make K singular to rounding: the upper bound is the longest, for all inputs alike,
/// at which it isn't.
Bounds search_bounds(const TensorDesign& design, const KrigingOptions& options) {
    const int n_inputs = design.n_parameters();
    const int n = options.nugget ? n_inputs : n_inputs + 1;
    Bounds bounds{VectorX::Constant(n, std::log(shortest_length)),
                  VectorX::Constant(n, std::log(longest_length))};
    if (!options.nugget) {
        bounds.lower[n_inputs] = std::log(least_nugget);
        bounds.upper[n_inputs] = std::log(largest_nugget);
    }
    const double nugget = options.nugget.value_or(least_nugget);
    double longest = longest_length;
    while (!CorrelationMatrix::factored(
        correlation_factors(design, options.correlation, VectorX::Constant(n_inputs, longest)),
        nugget)) {
        longest *= 0.8;
        if (longest < shortest_length) {
            throw InputError(
                "Kriging: the correlation matrix of {} points is singular; points coincide: take "
                "one of them out, or allow a nugget",
                design.n_points());
        }
    }
    bounds.upper.head(n_inputs).setConstant(std::log(longest));
    return bounds;
}

/// As kriging_objective, the sum over all columns of values. @param F  trend functions at the
/// points
double objective(const TensorDesign& design, const MatrixX& F, const MatrixX& values,
                 const KrigingOptions& options, const VectorX& log_parameters, VectorX& gradient) {
    const int n_inputs = design.n_parameters();
    const KrigingParameters parameters = to_parameters(log_parameters, n_inputs, options);
    const std::vector<MatrixX> factors =
        correlation_factors(design, options.correlation, parameters.lengths);
    auto factored = CorrelationMatrix::factored(factors, parameters.nugget, true);
    gradient = VectorX::Zero(log_parameters.size());
    if (!factored) {
        return std::numeric_limits<double>::infinity();
    }
    const KrigingSystem system(std::move(*factored), F);
    const CorrelationMatrix& K = system.correlation_matrix();
    std::vector<KrigingSystem::Fit> fits;
    double value = 0.0;
    for (Eigen::Index k = 0; k < values.cols(); ++k) {
        fits.push_back(system.fit(values.col(k)));
        value += 0.5 * (static_cast<double>(values.rows()) * std::log(fits.back().variance) +
                        K.log_determinant());
    }
    const std::vector<int> first = offsets(design);
    for (int g = 0; g < static_cast<int>(factors.size()); ++g) {
        const Eigen::Index n_g = design.factors[g].cols();
        MatrixX slope = MatrixX::Zero(factors[g].rows(), factors[g].cols());
        for (const KrigingSystem::Fit& fit : fits) {
            slope += K.likelihood_slope(g, fit.weights, fit.variance);
        }
        gradient.segment(first[g], n_g) = log_length_derivatives(
            options.correlation, design.factors[g], parameters.lengths.segment(first[g], n_g),
            slope.cwiseProduct(factors[g]));
    }
    if (!options.nugget) {
        const double trace = K.inverse_diagonal().sum();
        for (const KrigingSystem::Fit& fit : fits) {
            gradient[n_inputs] +=
                0.5 * parameters.nugget * (trace - fit.weights.squaredNorm() / fit.variance);
        }
    }
    return value;
}

}  // namespace

KrigingParameters most_likely_parameters(const TensorDesign& design, const MatrixX& values,
                                         const KrigingOptions& options) {
    const Bounds bounds = search_bounds(design, options);
    const auto n = static_cast<int>(bounds.lower.size());
    const MatrixX starts = latin_hypercube_design(n, options.n_starts, options.seed);
    const MatrixX F = independent_trend(design.points(), options.trend);
    const auto minimised = [&](const VectorX& x, VectorX& gradient) {
        return objective(design, F, values, options, x, gradient);
    };
    BoundedMinimum best{{}, std::numeric_limits<double>::infinity()};
    for (int i = 0; i < options.n_starts; ++i) {
        const VectorX start =
            bounds.lower + starts.row(i).transpose().cwiseProduct(bounds.upper - bounds.lower);
        const BoundedMinimum found =
            bounded_minimum(minimised, start, bounds.lower, bounds.upper, same_likelihood);
        if (found.value < best.value) {
            best = found;
        }
    }
    return to_parameters(best.x, design.n_parameters(), options);
}

double kriging_objective(const TensorDesign& design, const VectorX& values,
                         const KrigingOptions& options, const VectorX& log_parameters,
                         VectorX& gradient) {
    return objective(design, independent_trend(design.points(), options.trend), values, options,
                     log_parameters, gradient);
}

std::shared_ptr<const KrigingSystem> make_kriging_system(const TensorDesign& design,
                                                         const KrigingOptions& options,
                                                         const KrigingParameters& parameters) {
    auto K = CorrelationMatrix::factored(
        correlation_factors(design, options.correlation, parameters.lengths), parameters.nugget);
    if (!K) {
        throw InputError(
            "Kriging: the correlation matrix of {} points is singular with a nugget of {}; points "
            "coincide, or lengths are too long",
            design.n_points(), parameters.nugget);
    }
    return std::make_shared<const KrigingSystem>(std::move(*K),
                                                 independent_trend(design.points(), options.trend));
}

Kriging::Kriging(TensorDesign design, const VectorX& values, const KrigingOptions& options)
    : design_(std::move(design)), options_(options) {
    check(design_, values, options_);
    parameters_ = most_likely_parameters(design_, values, options_);
    fit(values);
}

Kriging::Kriging(TensorDesign design, const VectorX& values, const KrigingOptions& options,
                 KrigingParameters parameters)
    : design_(std::move(design)), options_(options), parameters_(std::move(parameters)) {
    check(design_, values, options_);
    fit(values);
}

Kriging::Kriging(TensorDesign design, const VectorX& values, const KrigingOptions& options,
                 KrigingParameters parameters, std::shared_ptr<const KrigingSystem> system)
    : design_(std::move(design)),
      options_(options),
      parameters_(std::move(parameters)),
      system_(std::move(system)) {
    check(design_, values, options_);
    fit(values);
}

void Kriging::fit(const VectorX& values) {
    if (!system_) system_ = make_kriging_system(design_, options_, parameters_);
    KrigingSystem::Fit fit = system_->fit(values);
    beta_ = std::move(fit.beta);
    weights_ = std::move(fit.weights);
    variance_ = fit.variance;
}

std::vector<MatrixX> Kriging::correlations_with(const VectorX& point) const {
    const std::vector<int> first = offsets(design_);
    std::vector<MatrixX> factors;
    for (std::size_t g = 0; g < design_.factors.size(); ++g) {
        const Eigen::Index n = design_.factors[g].cols();
        factors.push_back(correlations(options_.correlation, point.segment(first[g], n).transpose(),
                                       design_.factors[g],
                                       parameters_.lengths.segment(first[g], n)));
    }
    return factors;
}

namespace {

/// (k_1 x k_2 x ...) v for rows k_g.
double contract(const std::vector<MatrixX>& rows, std::vector<int> sizes, MatrixX v) {
    for (int g = static_cast<int>(rows.size()) - 1; g >= 0; --g) {
        v = apply_along(rows[g], g, sizes, v);
        sizes[g] = 1;
    }
    return v(0, 0);
}

VectorX product_row(const std::vector<MatrixX>& rows) {
    VectorX product = VectorX::Ones(1);
    for (const MatrixX& row : rows) {
        const MatrixX outer = row.transpose() * product.transpose();
        product = Eigen::Map<const VectorX>(outer.data(), outer.size());
    }
    return product;
}

}  // namespace

double Kriging::value(const VectorX& point) const {
    assert(point.size() == design_.n_parameters());
    const double trend =
        trend_functions(point.transpose(), options_.trend).row(0).dot(beta_.transpose());
    return trend + contract(correlations_with(point), design_.sizes(), weights_);
}

double Kriging::variance(const VectorX& k, const VectorX& point) const {
    return variance_ *
           system_->relative_variance(k, trend_functions(point.transpose(), options_.trend).row(0));
}

double Kriging::variance(const VectorX& point) const {
    return variance(product_row(correlations_with(point)), point);
}

Prediction Kriging::predict(const VectorX& point) const {
    Prediction prediction;
    const std::vector<MatrixX> rows = correlations_with(point);
    const VectorX k = product_row(rows);
    const MatrixX f = trend_functions(point.transpose(), options_.trend);
    prediction.value = f.row(0).dot(beta_.transpose()) + k.dot(weights_);
    prediction.variance = variance(k, point);

    prediction.gradient = trend_slopes(point, options_.trend).transpose() * beta_;
    const std::vector<int> first = offsets(design_);
    for (std::size_t g = 0; g < rows.size(); ++g) {
        const MatrixX& points = design_.factors[g];
        for (Eigen::Index input = 0; input < points.cols(); ++input) {
            const Eigen::Index i = first[g] + input;
            std::vector<MatrixX> slopes = rows;
            for (Eigen::Index j = 0; j < points.rows(); ++j) {
                slopes[g](0, j) *= difference_derivative(
                    options_.correlation, point[i] - points(j, input), parameters_.lengths[i]);
            }
            prediction.gradient[i] += contract(slopes, design_.sizes(), weights_);
        }
    }
    return prediction;
}

VectorX Kriging::leave_one_out() const {
    // With B = K^-1 - K^-1 F (F^T K^-1 F)^-1 F^T K^-1, B y are the weights.
    return weights_.cwiseQuotient(system_->residual_diagonal());
}

VectorX Kriging::leave_one_out_variances() const {
    return variance_ * system_->residual_diagonal().cwiseInverse();
}

}  // namespace couture::rom
