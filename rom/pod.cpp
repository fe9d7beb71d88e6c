#include "rom/pod.h"

#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>

#include "iga/core/error.h"
#include "rom/designs.h"

namespace couture::rom {

namespace {

struct Svd {
    MatrixX U;
    VectorX singular_values;
};

MatrixX orthonormal(const MatrixX& columns) {
    const Eigen::HouseholderQR<MatrixX> qr(columns);
    const Eigen::Index n = std::min(columns.rows(), columns.cols());
    return qr.householderQ() * MatrixX::Identity(columns.rows(), n);
}

Svd svd_of_r(const MatrixX& columns) {
    const Eigen::Index n = std::min(columns.rows(), columns.cols());
    const Eigen::HouseholderQR<MatrixX> qr(columns);
    const MatrixX R = qr.matrixQR().topRows(n).triangularView<Eigen::Upper>();
    const Eigen::BDCSVD<MatrixX> svd(R, Eigen::ComputeThinU);
    MatrixX U = MatrixX::Zero(columns.rows(), n);
    U.topRows(n) = svd.matrixU();
    return {qr.householderQ() * U, svd.singularValues()};
}

/// Leading singular vectors, from the range of random combinations of the columns.
Svd randomised_svd(const MatrixX& columns, int n_modes, std::uint64_t seed) {
    constexpr int oversampling = 20;
    constexpr int n_power_steps = 2;
    const Eigen::Index n =
        std::min<Eigen::Index>(n_modes + oversampling, std::min(columns.rows(), columns.cols()));
    MatrixX Q = orthonormal(
        columns * normal_design(static_cast<int>(n), static_cast<int>(columns.cols()), seed));
    for (int step = 0; step < n_power_steps; ++step) {
        Q = orthonormal(columns * orthonormal(columns.transpose() * Q));
    }
    const Svd small = svd_of_r((Q.transpose() * columns).transpose());
    // B = Q^T A = V S U'^T with V from the columns of B^T: U of A is Q times the left vectors of B.
    const MatrixX left = (Q.transpose() * columns) * small.U *
                         small.singular_values.cwiseMax(1e-300).cwiseInverse().asDiagonal();
    return {Q * left, small.singular_values};
}

int numerical_rank(const VectorX& singular_values, Eigen::Index n_rows, Eigen::Index n_columns) {
    const double least = singular_values[0] * std::numeric_limits<double>::epsilon() *
                         static_cast<double>(std::max(n_rows, n_columns));
    return static_cast<int>((singular_values.array() > least).count());
}

int wanted_modes(const PodBasis& basis, const PodOptions& options) {
    int n = 1;
    while (n < basis.rank &&
           (options.tolerance == 0.0 || basis.relative_error(n) > options.tolerance)) {
        ++n;
    }
    return std::min(n, options.n_modes.value_or(n));
}

/// SVDs leave the sign of a vector open.
void fix_signs(MatrixX& modes) {
    for (Eigen::Index j = 0; j < modes.cols(); ++j) {
        Eigen::Index largest = 0;
        modes.col(j).cwiseAbs().maxCoeff(&largest);
        if (modes(largest, j) < 0.0) {
            modes.col(j) *= -1.0;
        }
    }
}

void check(const MatrixX& snapshots, const PodOptions& options) {
    if (snapshots.size() == 0) {
        throw InputError("make_pod_basis: {} snapshots of {} values; there must be at least one",
                         snapshots.cols(), snapshots.rows());
    }
    if (options.n_modes && *options.n_modes < 1) {
        throw InputError("make_pod_basis: {} modes; there must be at least 1", *options.n_modes);
    }
    for (Eigen::Index j = 0; j < snapshots.cols(); ++j) {
        if (!snapshots.col(j).allFinite()) {
            throw InputError("make_pod_basis: snapshot {} has values that are not finite", j);
        }
    }
}

}  // namespace

double PodBasis::relative_error(int n_modes) const {
    const Eigen::Index n_left = std::max<Eigen::Index>(singular_values.size() - n_modes, 0);
    const double left = singular_values.tail(n_left).squaredNorm() + remaining_energy;
    const double all = singular_values.squaredNorm() + remaining_energy;
    return all > 0.0 ? std::sqrt(left / all) : 0.0;
}

PodBasis make_pod_basis(const MatrixX& snapshots, const InnerProduct& product,
                        const PodOptions& options) {
    check(snapshots, options);
    const MatrixX columns = product.to_euclidean(snapshots);
    const bool is_randomised = columns.cols() > options.randomised_above;
    constexpr int most_random_modes = 200;
    Svd svd = is_randomised ? randomised_svd(columns, options.n_modes.value_or(most_random_modes),
                                             options.seed)
                            : svd_of_r(columns);
    PodBasis basis;
    basis.singular_values = std::move(svd.singular_values);
    if (is_randomised) {
        basis.remaining_energy =
            std::max(0.0, columns.squaredNorm() - basis.singular_values.squaredNorm());
    }
    basis.rank = numerical_rank(basis.singular_values, columns.rows(), columns.cols());
    basis.modes = product.from_euclidean(svd.U.leftCols(wanted_modes(basis, options)));
    fix_signs(basis.modes);
    return basis;
}

MatrixX project(const PodBasis& basis, const InnerProduct& product, const MatrixX& fields) {
    return product.apply(basis.modes).transpose() * fields;
}

}  // namespace couture::rom
