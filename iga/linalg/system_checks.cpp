#include "iga/linalg/system_checks.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>

#include "iga/core/error.h"

namespace couture::iga {

namespace {

/// A motion is held by the fixed unknowns if it moves them by more than this part of its norm.
constexpr double held_part = 1e-8;
/// Rounding of A v relative to the largest entry of A: some hundred products per row.
constexpr double energy_rounding = 1e-13;

MatrixX rows_where(const std::vector<char>& is_fixed, const MatrixX& x) {
    MatrixX result = MatrixX::Zero(x.rows(), x.cols());
    for (std::size_t i = 0; i < is_fixed.size(); ++i) {
        if (is_fixed[i] != 0) {
            result.row(static_cast<Eigen::Index>(i)) = x.row(static_cast<Eigen::Index>(i));
        }
    }
    return result;
}

}  // namespace

void check_system(const LinearSystem& system, const std::string& solver) {
    const BlockMatrix& A = system.matrix;
    if (!system.is_fixed.empty() && static_cast<int>(system.is_fixed.size()) != A.n_unknowns()) {
        throw InputError("{}: {} flags of fixed unknowns for {} unknowns", solver,
                         system.is_fixed.size(), A.n_unknowns());
    }
    if (system.near_null_space.size() > 0 && system.near_null_space.rows() != A.n_unknowns()) {
        throw InputError("{}: the near null space has {} rows for {} unknowns", solver,
                         system.near_null_space.rows(), A.n_unknowns());
    }
    for (int row = 0; row < A.n_rows; ++row) {
        if (A.find(row, row) == nullptr) {
            throw InputError("{}: block row {} has no diagonal block; every row needs one", solver,
                             row);
        }
    }
}

void check_right_hand_side(const BlockMatrix& matrix, const MatrixX& b, const std::string& solver) {
    if (b.rows() != matrix.n_unknowns()) {
        throw InputError("{}: the right-hand side has {} rows; must be the {} unknowns", solver,
                         b.rows(), matrix.n_unknowns());
    }
    for (Eigen::Index k = 0; k < b.cols(); ++k) {
        for (Eigen::Index i = 0; i < b.rows(); ++i) {
            if (!std::isfinite(b(i, k))) {
                throw InputError("{}: right-hand side {} is {} at {}; must be finite", solver, k,
                                 b(i, k), describe_unknown(matrix, static_cast<int>(i)));
            }
        }
    }
}

MatrixX free_part(const std::vector<char>& is_fixed, const MatrixX& b) {
    MatrixX result = b;
    for (std::size_t i = 0; i < is_fixed.size(); ++i) {
        if (is_fixed[i] != 0) {
            result.row(static_cast<Eigen::Index>(i)).setZero();
        }
    }
    return result;
}

MatrixX residual(const BlockMatrix& matrix, const std::vector<char>& is_fixed, const MatrixX& b,
                 const MatrixX& x) {
    return free_part(is_fixed, b - matrix * x);
}

double worst_ratio(const MatrixX& r, const MatrixX& b) {
    double worst = 0.0;
    for (Eigen::Index k = 0; k < b.cols(); ++k) {
        const double r_norm = r.col(k).norm();
        if (r_norm != 0.0) {
            const double ratio = r_norm / b.col(k).norm();
            worst = std::isnan(ratio) ? std::numeric_limits<double>::infinity()
                                      : std::max(worst, ratio);
        }
    }
    return worst;
}

double rounding_ratio(const BlockMatrix& matrix, const std::vector<char>& is_fixed,
                      const MatrixX& b, const MatrixX& x) {
    const int n = matrix.block_size;
    MatrixX sums = MatrixX::Zero(x.rows(), x.cols());
    for (int row = 0; row < matrix.n_rows; ++row) {
        for (std::int64_t e = matrix.row_begin[row]; e < matrix.row_begin[row + 1]; ++e) {
            const int column = matrix.columns[e];
            for (int i = 0; i < n; ++i) {
                for (int j = 0; j < n; ++j) {
                    const double a = std::abs(matrix.values[(e * n + i) * n + j]);
                    sums.row(n * row + i) += a * x.row(n * column + j).cwiseAbs();
                    if (matrix.is_symmetric && column != row) {
                        sums.row(n * column + j) += a * x.row(n * row + i).cwiseAbs();
                    }
                }
            }
        }
    }
    return std::numeric_limits<double>::epsilon() * worst_ratio(free_part(is_fixed, sums), b);
}

MatrixX orthonormal_basis(const MatrixX& columns) {
    constexpr double dependent = 1e-10;
    MatrixX basis(columns.rows(), columns.cols());
    Eigen::Index rank = 0;
    for (Eigen::Index k = 0; k < columns.cols(); ++k) {
        VectorX v = columns.col(k);
        const double norm = v.norm();
        // Gram-Schmidt twice is as good as Householder.
        for (int pass = 0; pass < 2; ++pass) {
            const VectorX parts = basis.leftCols(rank).transpose() * v;
            v -= basis.leftCols(rank) * parts;
        }
        if (v.norm() > dependent * norm) {
            basis.col(rank++) = v.normalized();
        }
    }
    return basis.leftCols(rank);
}

int n_unconstrained_motions(const LinearSystem& system) {
    if (system.near_null_space.cols() == 0) {
        return 0;
    }
    const MatrixX motions = orthonormal_basis(system.near_null_space);
    const MatrixX held = rows_where(system.is_fixed, motions);
    const Eigen::SelfAdjointEigenSolver<MatrixX> held_energy(held.transpose() * held);
    Eigen::Index n_free = 0;
    while (n_free < motions.cols() && held_energy.eigenvalues()[n_free] < held_part * held_part) {
        ++n_free;
    }
    if (n_free == 0) {
        return 0;
    }
    const MatrixX free_motions = motions * held_energy.eigenvectors().leftCols(n_free);
    const MatrixX forces = free_part(system.is_fixed, system.matrix * free_motions);
    double largest = 0.0;
    for (const double value : system.matrix.values) {
        largest = std::max(largest, std::abs(value));
    }
    const Eigen::SelfAdjointEigenSolver<MatrixX> energy(forces.transpose() * forces);
    int n_motions = 0;
    for (Eigen::Index k = 0; k < n_free; ++k) {
        const double force = std::sqrt(std::max(energy.eigenvalues()[k], 0.0));
        n_motions += force <= energy_rounding * largest ? 1 : 0;
    }
    return n_motions;
}

void check_constrained(const LinearSystem& system, const std::string& solver) {
    const int n_motions = n_unconstrained_motions(system);
    if (n_motions > 0) {
        throw SolverError(
            "{}: the matrix is singular: {} of {} rigid-body motions are unconstrained; fix more "
            "unknowns",
            solver, n_motions, system.near_null_space.cols());
    }
}

std::string describe_unknown(const BlockMatrix& matrix, int unknown) {
    return fmt::format("unknown {} (component {} of block row {})", unknown,
                       unknown % matrix.block_size, unknown / matrix.block_size);
}

}  // namespace couture::iga
