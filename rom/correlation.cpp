#include "rom/correlation.h"

#include <cmath>

namespace couture::rom {

namespace {

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

double log_length_derivative(CorrelationKind kind, double difference, double length) {
    if (kind == CorrelationKind::gaussian) {
        const double r = difference / length;
        return r * r;
    }
    const double s = scaled(difference, length);
    return s * s * (1.0 + s) / (3.0 * matern_polynomial(s));
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
    MatrixX products(a.rows(), b.rows());
    for (Eigen::Index j = 0; j < b.rows(); ++j) {
        for (Eigen::Index i = 0; i < a.rows(); ++i) {
            double product = 1.0;
            for (Eigen::Index axis = 0; axis < a.cols(); ++axis) {
                product *= correlation(kind, a(i, axis) - b(j, axis), lengths[axis]);
            }
            products(i, j) = product;
        }
    }
    return products;
}

}  // namespace couture::rom
