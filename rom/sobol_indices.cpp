#include "rom/sobol_indices.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "iga/core/error.h"
#include "rom/designs.h"

namespace couture::rom {

namespace {

/// One function at A, B and all A_i: n_samples values, n_samples x n_inputs.
struct Samples {
    VectorX A;
    VectorX B;
    MatrixX A_i;
};

struct Estimates {
    double mean = 0.0;
    double variance = 0.0;
    /// By products, by squared differences.
    VectorX first_saltelli;
    VectorX first_jansen;
    VectorX total;
};

/// @param rows  samples that count, some of them several times
Estimates estimate(const Samples& samples, const std::vector<int>& rows) {
    const auto n = static_cast<double>(rows.size());
    const Eigen::Index n_inputs = samples.A_i.cols();
    Estimates result{0.0, 0.0, VectorX::Zero(n_inputs), VectorX::Zero(n_inputs),
                     VectorX::Zero(n_inputs)};
    for (const int r : rows) {
        result.mean += (samples.A[r] + samples.B[r]) / (2.0 * n);
    }
    for (const int r : rows) {
        const double a = samples.A[r] - result.mean;
        const double b = samples.B[r] - result.mean;
        result.variance += (a * a + b * b) / (2.0 * n - 1.0);
    }
    const double scale = samples.A.cwiseAbs().maxCoeff();
    constexpr double rounding = 1e-14;
    if (!(result.variance > rounding * rounding * scale * scale)) {
        result.variance = 0.0;
        return result;
    }
    for (Eigen::Index i = 0; i < n_inputs; ++i) {
        for (const int r : rows) {
            const double b = samples.B[r] - samples.A_i(r, i);
            const double a = samples.A[r] - samples.A_i(r, i);
            result.first_saltelli[i] -= (samples.B[r] - result.mean) * a;
            result.first_jansen[i] += b * b;
            result.total[i] += a * a;
        }
    }
    result.first_saltelli /= n * result.variance;
    result.first_jansen = 1.0 - (result.first_jansen / (2.0 * n * result.variance)).array();
    result.total /= 2.0 * n * result.variance;
    return result;
}

/// Linear between the sorted values.
double quantile(const VectorX& sorted, double part) {
    const double place = part * static_cast<double>(sorted.size() - 1);
    const auto i = std::min(static_cast<Eigen::Index>(place), sorted.size() - 2);
    const double t = place - static_cast<double>(i);
    return (1.0 - t) * sorted[i] + t * sorted[i + 1];
}

std::vector<IndexEstimate> with_intervals(const VectorX& values, const MatrixX& resampled,
                                          double confidence) {
    std::vector<IndexEstimate> result;
    for (Eigen::Index i = 0; i < values.size(); ++i) {
        VectorX column = resampled.row(i);
        std::sort(column.begin(), column.end());
        result.push_back({values[i], quantile(column, 0.5 * (1.0 - confidence)),
                          quantile(column, 0.5 * (1.0 + confidence))});
    }
    return result;
}

SobolIndices indices_of(const Samples& samples, const SobolOptions& options) {
    const auto n = static_cast<int>(samples.A.size());
    std::vector<int> rows(n);
    for (int r = 0; r < n; ++r) {
        rows[r] = r;
    }
    const Estimates all = estimate(samples, rows);
    MatrixX saltelli(samples.A_i.cols(), options.n_bootstrap);
    MatrixX jansen = saltelli;
    MatrixX total = saltelli;
    std::mt19937_64 random(options.seed);
    for (int k = 0; k < options.n_bootstrap; ++k) {
        // The remainder is the same on every machine, its bias below 1e-13.
        for (int& r : rows) {
            r = static_cast<int>(random() % static_cast<std::uint64_t>(n));
        }
        const Estimates one = estimate(samples, rows);
        saltelli.col(k) = one.first_saltelli;
        jansen.col(k) = one.first_jansen;
        total.col(k) = one.total;
    }
    std::vector<IndexEstimate> first =
        with_intervals(all.first_saltelli, saltelli, options.confidence);
    const std::vector<IndexEstimate> other =
        with_intervals(all.first_jansen, jansen, options.confidence);
    for (std::size_t i = 0; i < first.size(); ++i) {
        if (other[i].high - other[i].low < first[i].high - first[i].low) first[i] = other[i];
    }
    return {all.mean, all.variance, std::move(first),
            with_intervals(all.total, total, options.confidence)};
}

}  // namespace

std::vector<SobolIndices> sobol_indices(
    int n_inputs, const std::function<MatrixX(const MatrixX& points)>& functions,
    const SobolOptions& options) {
    if (n_inputs < 1 || options.n_samples < 2 || options.n_bootstrap < 2) {
        throw InputError(
            "sobol_indices: {} inputs, {} samples, {} resampled estimates; there must be 1, 2 and "
            "2 at least",
            n_inputs, options.n_samples, options.n_bootstrap);
    }
    const MatrixX both = sobol_design(2 * n_inputs, options.n_samples);
    const MatrixX A = both.leftCols(n_inputs);
    const MatrixX B = both.rightCols(n_inputs);
    const auto values_at = [&](const MatrixX& points) {
        MatrixX values = functions(points);
        if (values.rows() != points.rows() || !values.allFinite()) {
            throw InputError(
                "sobol_indices: {} values of functions at {} points, or one that is not finite",
                values.rows(), points.rows());
        }
        return values;
    };
    const MatrixX at_A = values_at(A);
    const MatrixX at_B = values_at(B);
    std::vector<Samples> samples;
    for (Eigen::Index f = 0; f < at_A.cols(); ++f) {
        samples.push_back({at_A.col(f), at_B.col(f), MatrixX(options.n_samples, n_inputs)});
    }
    for (int i = 0; i < n_inputs; ++i) {
        MatrixX mixed = A;
        mixed.col(i) = B.col(i);
        const MatrixX values = values_at(mixed);
        for (std::size_t f = 0; f < samples.size(); ++f) {
            samples[f].A_i.col(i) = values.col(static_cast<Eigen::Index>(f));
        }
    }
    std::vector<SobolIndices> result;
    for (const Samples& one : samples) {
        result.push_back(indices_of(one, options));
    }
    return result;
}

}  // namespace couture::rom
