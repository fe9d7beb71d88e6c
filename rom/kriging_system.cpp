#include "rom/kriging_system.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <limits>

namespace couture::rom {

namespace {

/// Of trend functions that are left out: their coefficients are 0 and add nothing to variances.
constexpr double weight_of_none = 1e300;
/// Values that are constant but for rounding.
constexpr double least_variance = std::numeric_limits<double>::min();

}  // namespace

KrigingSystem::KrigingSystem(CorrelationMatrix K, MatrixX F)
    : K_(std::move(K)), F_(std::move(F)), K_inverse_F_(K_.solve(F_)) {
    MatrixX products = F_.transpose() * K_inverse_F_;
    for (Eigen::Index j = 0; j < F_.cols(); ++j) {
        if (F_.col(j).isZero(0.0)) products(j, j) = weight_of_none;
    }
    trend_factor_ = Eigen::LLT<MatrixX>(products).matrixL();
}

KrigingSystem::Fit KrigingSystem::fit(const VectorX& values) const {
    const auto L = trend_factor_.triangularView<Eigen::Lower>();
    Fit result;
    const VectorX reduced = L.solve(K_inverse_F_.transpose() * values);
    result.beta = L.transpose().solve(reduced);
    const VectorX residual = values - F_ * result.beta;
    result.weights = K_.solve(residual);
    result.variance =
        std::max(residual.dot(result.weights) / static_cast<double>(values.size()), least_variance);
    return result;
}

double KrigingSystem::relative_variance(const VectorX& k, const VectorX& f) const {
    const VectorX u =
        trend_factor_.triangularView<Eigen::Lower>().solve(K_inverse_F_.transpose() * k - f);
    return std::max(0.0, 1.0 - k.dot(K_.solve(k).col(0)) + u.squaredNorm());
}

const VectorX& KrigingSystem::residual_diagonal() const {
    std::call_once(is_made_, [&] {
        const MatrixX G =
            trend_factor_.triangularView<Eigen::Lower>().solve(K_inverse_F_.transpose());
        residual_diagonal_ = K_.inverse_diagonal() - G.colwise().squaredNorm().transpose();
    });
    return residual_diagonal_;
}

}  // namespace couture::rom
