#include "iga/linalg/box_solver.h"

#include <algorithm>
#include <limits>

#include "iga/core/parallel.h"

namespace couture::iga {

namespace {

/// Eigenvalues below this part of the largest are rounding.
constexpr double zero_eigenvalue = 1e-12;

using Strided = Eigen::Map<MatrixX, 0, Eigen::OuterStride<>>;

}  // namespace

void shift_zeros(VectorX& values) {
    const double zero = values.size() > 0 ? zero_eigenvalue * values.maxCoeff() : 0.0;
    double lowest = std::numeric_limits<double>::max();
    for (const double value : values) {
        lowest = value > zero ? std::min(lowest, value) : lowest;
    }
    if (lowest == std::numeric_limits<double>::max()) {
        lowest = 1.0;
    }
    for (double& value : values) {
        value = value > zero ? value : lowest;
    }
}

BoxSolver::BoxSolver(std::array<std::shared_ptr<const Eigenbasis>, 3> bases,
                     const PatchCoefficients& coefficients)
    : bases_(std::move(bases)), inverses_(size()) {
    Eigen::Index i = 0;
    for (int i2 = 0; i2 < size(2); ++i2) {
        for (int i1 = 0; i1 < size(1); ++i1) {
            for (int i0 = 0; i0 < size(0); ++i0) {
                inverses_[i++] = coefficients.stretch[0] * bases_[0]->values[i0] +
                                 coefficients.stretch[1] * bases_[1]->values[i1] +
                                 coefficients.stretch[2] * bases_[2]->values[i2] +
                                 coefficients.reaction;
            }
        }
    }
    shift_zeros(inverses_);
    inverses_ = inverses_.cwiseInverse();
}

void BoxSolver::solve(VectorX& values) const {
    if (values.size() == 0) {
        return;
    }
    const Eigen::Index n0 = size(0);
    const Eigen::Index n1 = size(1);
    const Eigen::Index n2 = size(2);
    const MatrixX& U0 = bases_[0]->vectors;
    const MatrixX& U1 = bases_[1]->vectors;
    const MatrixX& U2 = bases_[2]->vectors;
    parallel_for(size(2), [&](int i) {
        Eigen::Map<MatrixX> plane(values.data() + i * n0 * n1, n0, n1);
        const MatrixX half = U0.transpose() * plane;
        plane.noalias() = half * U1;
    });
    parallel_for(size(1), [&](int i) {
        Strided plane(values.data() + i * n0, n0, n2, Eigen::OuterStride<>(n0 * n1));
        const Eigen::Map<const MatrixX, 0, Eigen::OuterStride<>> inverses(
            inverses_.data() + i * n0, n0, n2, Eigen::OuterStride<>(n0 * n1));
        const MatrixX transformed = (plane * U2).cwiseProduct(inverses);
        plane.noalias() = transformed * U2.transpose();
    });
    parallel_for(size(2), [&](int i) {
        Eigen::Map<MatrixX> plane(values.data() + i * n0 * n1, n0, n1);
        const MatrixX half = U0 * plane;
        plane.noalias() = half * U1.transpose();
    });
}

}  // namespace couture::iga
