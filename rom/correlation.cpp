#include "rom/correlation.h"

#include <cmath>

namespace couture::rom {

namespace {

using ArrayX = Eigen::ArrayXd;

double scaled(double difference, double length) {
    return std::sqrt(5.0) * std::abs(difference) / length;
}

double matern_polynomial(double s) { return 1.0 + s + s * s / 3.0; }

}  // namespace

double correlation(CorrelationKind kind, double difference, double length) {
    if (kind == CorrelationKind::gaussian) {
        const double r = difference / length;
        return std::exp(-0.5 * r * r);
    }
    const double s = scaled(difference, length);
    return matern_polynomial(s) * std::exp(-s);
}

double difference_derivative(CorrelationKind kind, double difference, double length) {
    if (kind == CorrelationKind::gaussian) {
        return -difference / (length * length);
    }
    const double s = scaled(difference, length);
    return -(5.0 / 3.0) * difference / (length * length) * (1.0 + s) / matern_polynomial(s);
}

MatrixX correlations(CorrelationKind kind, const MatrixX& a, const MatrixX& b,
                     const VectorX& lengths) {
    const Eigen::Index n = a.rows();
    MatrixX products(n, b.rows());
    ArrayX exponent(n);
    ArrayX polynomial(n);
    ArrayX s(n);
    for (Eigen::Index j = 0; j < b.rows(); ++j) {
        exponent.setZero();
        polynomial.setOnes();
        for (Eigen::Index axis = 0; axis < a.cols(); ++axis) {
            if (kind == CorrelationKind::gaussian) {
                s = (a.col(axis).array() - b(j, axis)) / lengths[axis];
                exponent += 0.5 * s * s;
            } else {
                s = (a.col(axis).array() - b(j, axis)).abs() * (std::sqrt(5.0) / lengths[axis]);
                exponent += s;
                polynomial *= 1.0 + s + s * s * (1.0 / 3.0);
            }
        }
        products.col(j) = polynomial * (-exponent).exp();
    }
    return products;
}

VectorX log_length_derivatives(CorrelationKind kind, const MatrixX& points, const VectorX& lengths,
                               const MatrixX& weights) {
    const Eigen::Index n = points.rows();
    VectorX sums = VectorX::Zero(points.cols());
    ArrayX s(n);
    for (Eigen::Index j = 0; j < n; ++j) {
        // Below the diagonal, twice; on it the derivatives vanish.
        const Eigen::Index m = n - 1 - j;
        const auto w = weights.col(j).tail(m).array();
        for (Eigen::Index axis = 0; axis < points.cols(); ++axis) {
            const auto difference = points.col(axis).tail(m).array() - points(j, axis);
            if (kind == CorrelationKind::gaussian) {
                s.head(m) = difference / lengths[axis];
                sums[axis] += 2.0 * (w * s.head(m).square()).sum();
            } else {
                s.head(m) = difference.abs() * (std::sqrt(5.0) / lengths[axis]);
                sums[axis] += 2.0 * (w * s.head(m).square() * (1.0 + s.head(m)) /
                                     (3.0 + 3.0 * s.head(m) + s.head(m).square()))
                                        .sum();
            }
        }
    }
    return sums;
}

}  // namespace couture::rom
