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

SymmetricDirichlet::SymmetricDirichlet(const Matrix<2>& F) : energy(symmetric_dirichlet(F)) {
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
    gradient = U * Vector2(0.5 * (s - 1.0 / s3), 0.5 * (t - 1.0 / t3)).asDiagonal() * Vt;
    modes[0] = U.col(0) * Vt.row(0);
    modes[1] = U.col(1) * Vt.row(1);
    const Matrix<2> upper = U.col(0) * Vt.row(1);
    const Matrix<2> lower = U.col(1) * Vt.row(0);
    modes[2] = (lower - upper) / std::numbers::sqrt2;
    modes[3] = (lower + upper) / std::numbers::sqrt2;
    eigenvalues[0] = 0.5 * (1.0 + 3.0 / (s3 * s));
    eigenvalues[1] = 0.5 * (1.0 + 3.0 / (t3 * t));
    eigenvalues[2] = std::max(0.0, 0.5 * (1.0 - (s * s - s * t + t * t) / (s3 * t3)));
    eigenvalues[3] = 0.5 * (1.0 + (s * s + s * t + t * t) / (s3 * t3));
}

}  // namespace couture::meshing
