#include "meshing/parameterization/symmetric_dirichlet.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace couture::meshing {

namespace {

Matrix<2> rotation(double angle) {
    Matrix<2> R;
    R << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
    return R;
}

}  // namespace

double symmetric_dirichlet(const Matrix<2>& F) {
    const double det = F.determinant();
    if (!(det > 0.0)) return std::numeric_limits<double>::infinity();
    return 0.25 * F.squaredNorm() * (1.0 + 1.0 / (det * det));
}

SymmetricDirichlet::SymmetricDirichlet(const Matrix<2>& F, double weight, double area_weight)
    : energy((weight + area_weight * F.determinant()) * symmetric_dirichlet(F)) {
    // Singular values of a 2 x 2 matrix: of its similar and its mirrored part.
    const double e = 0.5 * (F(0, 0) + F(1, 1));
    const double f = 0.5 * (F(0, 0) - F(1, 1));
    const double g = 0.5 * (F(1, 0) + F(0, 1));
    const double h = 0.5 * (F(1, 0) - F(0, 1));
    const double s = std::hypot(e, h) + std::hypot(f, g);
    const double t = F.determinant() / s;
    const double mirrored = std::atan2(g, f);
    const double similar = std::atan2(h, e);
    const Matrix<2> U = rotation(0.5 * (similar + mirrored));
    const Matrix<2> Vt = rotation(0.5 * (similar - mirrored));

    const double s3 = s * s * s;
    const double t3 = t * t * t;
    const double w = 0.5 * weight;
    const double w_area = 0.25 * area_weight;
    const Vector2 slopes(
        w * (s - 1.0 / s3) + w_area * (3.0 * s * s * t + t3 + 1.0 / t - t / (s * s)),
        w * (t - 1.0 / t3) + w_area * (3.0 * t * t * s + s3 + 1.0 / s - s / (t * t)));
    gradient = U * slopes.asDiagonal() * Vt;

    // The stretches.
    const double ss = w * (1.0 + 3.0 / (s3 * s)) + w_area * (6.0 * s * t + 2.0 * t / s3);
    const double tt = w * (1.0 + 3.0 / (t3 * t)) + w_area * (6.0 * s * t + 2.0 * s / t3);
    const double st = w_area * (3.0 * (s * s + t * t) - 1.0 / (s * s) - 1.0 / (t * t));
    const double angle = 0.5 * std::atan2(2.0 * st, ss - tt);
    const double mean = 0.5 * (ss + tt);
    const double radius = std::hypot(0.5 * (ss - tt), st);
    const Matrix<2> along_s = U.col(0) * Vt.row(0);
    const Matrix<2> along_t = U.col(1) * Vt.row(1);
    modes[0] = std::cos(angle) * along_s + std::sin(angle) * along_t;
    modes[1] = std::cos(angle) * along_t - std::sin(angle) * along_s;
    eigenvalues[0] = mean + radius;
    eigenvalues[1] = std::max(0.0, mean - radius);

    const Matrix<2> upper = U.col(0) * Vt.row(1);
    const Matrix<2> lower = U.col(1) * Vt.row(0);
    modes[2] = (lower - upper) / std::numbers::sqrt2;
    modes[3] = (lower + upper) / std::numbers::sqrt2;
    const double sum_squared = (s + t) * (s + t);
    const double difference_squared = (s - t) * (s - t);
    const double inverse = 1.0 / (s * s * t * t);
    eigenvalues[2] = std::max(0.0, w * (1.0 - (s * s - s * t + t * t) / (s3 * t3)) +
                                       w_area * (sum_squared - difference_squared * inverse));
    eigenvalues[3] = std::max(0.0, w * (1.0 + (s * s + s * t + t * t) / (s3 * t3)) +
                                       w_area * (sum_squared * inverse - difference_squared));
}

}  // namespace couture::meshing
