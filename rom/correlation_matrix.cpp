#include "rom/correlation_matrix.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cassert>
#include <limits>

namespace couture::rom {

namespace {

std::vector<int> sizes_of(const std::vector<MatrixX>& matrices) {
    std::vector<int> sizes;
    for (const MatrixX& matrix : matrices) {
        sizes.push_back(static_cast<int>(matrix.cols()));
    }
    return sizes;
}

VectorX kronecker(const std::vector<VectorX>& vectors) {
    VectorX product = VectorX::Ones(1);
    for (const VectorX& vector : vectors) {
        VectorX next(product.size() * vector.size());
        for (Eigen::Index i = 0; i < product.size(); ++i) {
            next.segment(i * vector.size(), vector.size()) = product[i] * vector;
        }
        product = std::move(next);
    }
    return product;
}

std::vector<MatrixX> transposed(const std::vector<MatrixX>& matrices) {
    std::vector<MatrixX> result;
    for (const MatrixX& matrix : matrices) {
        result.push_back(matrix.transpose());
    }
    return result;
}

/// Smallest over largest eigenvalue that rounding leaves meaningful.
double least_ratio(Eigen::Index n) {
    return static_cast<double>(n) * std::numeric_limits<double>::epsilon();
}

}  // namespace

MatrixX apply_along(const MatrixX& A, int i_factor, const std::vector<int>& sizes,
                    const MatrixX& B) {
    Eigen::Index before = 1;
    Eigen::Index after = 1;
    for (int g = 0; g < static_cast<int>(sizes.size()); ++g) {
        (g < i_factor ? before : after) *= g == i_factor ? 1 : sizes[g];
    }
    const Eigen::Index n = A.cols();
    const Eigen::Index m = A.rows();
    assert(n == sizes[i_factor] && B.rows() == before * n * after);
    MatrixX result(before * m * after, B.cols());
    for (Eigen::Index column = 0; column < B.cols(); ++column) {
        for (Eigen::Index block = 0; block < before; ++block) {
            // Columns of this map run along the factor: after x n.
            const Eigen::Map<const MatrixX> from(B.col(column).data() + block * n * after, after,
                                                 n);
            Eigen::Map<MatrixX> to(result.col(column).data() + block * m * after, after, m);
            to.noalias() = from * A.transpose();
        }
    }
    return result;
}

MatrixX apply_kronecker(const std::vector<MatrixX>& A, const MatrixX& B) {
    const std::vector<int> sizes = sizes_of(A);
    MatrixX result = B;
    for (int g = 0; g < static_cast<int>(A.size()); ++g) {
        result = apply_along(A[g], g, sizes, result);
    }
    return result;
}

std::optional<CorrelationMatrix> CorrelationMatrix::factored(std::vector<MatrixX> factors,
                                                             double nugget, bool has_slopes) {
    assert(!factors.empty() && nugget >= 0.0);
    CorrelationMatrix matrix;
    matrix.sizes_ = sizes_of(factors);
    matrix.factors_ = std::move(factors);
    matrix.nugget_ = nugget;
    if (!matrix.factor(has_slopes)) {
        return std::nullopt;
    }
    return matrix;
}

bool CorrelationMatrix::factor(bool has_slopes) {
    if (factors_.size() == 1) {
        MatrixX K = factors_.front();
        const Eigen::Index n = K.rows();
        K.diagonal().array() += nugget_;
        const Eigen::LLT<MatrixX> cholesky(K);
        if (cholesky.info() != Eigen::Success || cholesky.rcond() < least_ratio(n)) {
            return false;
        }
        L_ = cholesky.matrixL();
        if (has_slopes) {
            const MatrixX L_inverse =
                L_.triangularView<Eigen::Lower>().solve(MatrixX::Identity(n, n));
            inverse_ = MatrixX::Zero(n, n);
            inverse_.selfadjointView<Eigen::Lower>().rankUpdate(L_inverse.transpose());
            inverse_.triangularView<Eigen::StrictlyUpper>() = inverse_.transpose();
        }
        return true;
    }
    for (const MatrixX& K : factors_) {
        const Eigen::SelfAdjointEigenSolver<MatrixX> solver(K);
        eigenvectors_.push_back(solver.eigenvectors());
        // Rounding leaves the smallest ones below zero.
        factor_eigenvalues_.emplace_back(solver.eigenvalues().cwiseMax(0.0));
    }
    eigenvalues_ = kronecker(factor_eigenvalues_).array() + nugget_;
    return eigenvalues_.minCoeff() > least_ratio(eigenvalues_.size()) * eigenvalues_.maxCoeff();
}

MatrixX CorrelationMatrix::solve(const MatrixX& B) const {
    if (factors_.size() == 1) {
        const auto L = L_.triangularView<Eigen::Lower>();
        return L.transpose().solve(L.solve(B));
    }
    MatrixX X = apply_kronecker(transposed(eigenvectors_), B);
    X.array().colwise() /= eigenvalues_.array();
    return apply_kronecker(eigenvectors_, X);
}

double CorrelationMatrix::log_determinant() const {
    return factors_.size() == 1 ? 2.0 * L_.diagonal().array().log().sum()
                                : eigenvalues_.array().log().sum();
}

VectorX CorrelationMatrix::inverse_diagonal() const {
    if (factors_.size() == 1) {
        if (inverse_.size() > 0) {
            return inverse_.diagonal();
        }
        const Eigen::Index n = L_.rows();
        const MatrixX L_inverse = L_.triangularView<Eigen::Lower>().solve(MatrixX::Identity(n, n));
        return L_inverse.colwise().squaredNorm();
    }
    std::vector<MatrixX> squares;
    for (const MatrixX& Q : eigenvectors_) {
        squares.emplace_back(Q.cwiseAbs2());
    }
    return apply_kronecker(squares, eigenvalues_.cwiseInverse());
}

MatrixX CorrelationMatrix::likelihood_slope(int i_factor, const VectorX& w, double variance) const {
    if (factors_.size() == 1) {
        assert(inverse_.size() > 0);
        return 0.5 * (inverse_ - w * (w.transpose() / variance));
    }
    // tr(K^-1 (K_1 x ... dK ...)) is the sum of c_j q_j^T dK q_j over the eigenvectors of K_g.
    std::vector<VectorX> others = factor_eigenvalues_;
    others[i_factor].setOnes();
    const VectorX ratios = kronecker(others).cwiseQuotient(eigenvalues_);
    std::vector<MatrixX> sums;
    for (int g = 0; g < static_cast<int>(factors_.size()); ++g) {
        sums.push_back(g == i_factor ? MatrixX(MatrixX::Identity(sizes_[g], sizes_[g]))
                                     : MatrixX(MatrixX::Ones(1, sizes_[g])));
    }
    std::vector<int> sizes = sizes_;
    MatrixX c = ratios;
    MatrixX Kw = w;
    for (int g = 0; g < static_cast<int>(factors_.size()); ++g) {
        if (g == i_factor) continue;
        c = apply_along(sums[g], g, sizes, c);
        sizes[g] = 1;
        Kw = apply_along(factors_[g], g, sizes_, Kw);
    }
    const MatrixX& Q = eigenvectors_[i_factor];
    MatrixX slope = Q * c.col(0).asDiagonal() * Q.transpose();
    Eigen::Index after = 1;
    for (int g = i_factor + 1; g < static_cast<int>(sizes_.size()); ++g) after *= sizes_[g];
    const Eigen::Index n = sizes_[i_factor];
    for (Eigen::Index first = 0; first < w.size(); first += n * after) {
        const Eigen::Map<const MatrixX> a(w.data() + first, after, n);
        const Eigen::Map<const MatrixX> b(Kw.data() + first, after, n);
        slope -= a.transpose() * b / variance;
    }
    return 0.5 * slope;
}

}  // namespace couture::rom
