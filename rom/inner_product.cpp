#include "rom/inner_product.h"

#include <Eigen/SparseCholesky>

#include "iga/core/error.h"

namespace couture::rom {

/// P W P^T = L L^T, hence R = L^T P.
struct InnerProduct::Factorization {
    Eigen::SimplicialLLT<SparseMatrix> cholesky;
};

namespace {

/// n_nodes x (n_components n_fields): the components of a field side by side.
MatrixX by_nodes(const MatrixX& fields, int n_components) {
    const Eigen::Index n_nodes = fields.rows() / n_components;
    MatrixX columns(n_nodes, n_components * fields.cols());
    for (Eigen::Index j = 0; j < fields.cols(); ++j) {
        const Eigen::Map<const MatrixX> field(fields.col(j).data(), n_components, n_nodes);
        columns.middleCols(j * n_components, n_components) = field.transpose();
    }
    return columns;
}

MatrixX by_fields(const MatrixX& columns, int n_components) {
    const Eigen::Index n_nodes = columns.rows();
    MatrixX fields(n_nodes * n_components, columns.cols() / n_components);
    for (Eigen::Index j = 0; j < fields.cols(); ++j) {
        Eigen::Map<MatrixX> field(fields.col(j).data(), n_components, n_nodes);
        field = columns.middleCols(j * n_components, n_components).transpose();
    }
    return fields;
}

}  // namespace

InnerProduct::InnerProduct(int n_components) : n_components_(n_components) {}

InnerProduct::InnerProduct(const SparseMatrix& mass, int n_components)
    : n_components_(n_components), mass_(mass) {
    auto factorization = std::make_shared<Factorization>();
    factorization->cholesky.compute(mass_);
    if (factorization->cholesky.info() != Eigen::Success) {
        throw SolverError(
            "InnerProduct: the mass matrix ({} x {}) is not positive definite; elements of the "
            "reference member fold, or a function has no support",
            mass_.rows(), mass_.cols());
    }
    factorization_ = std::move(factorization);
}

void InnerProduct::check(const MatrixX& fields) const {
    if (fields.rows() % n_components_ != 0 ||
        (!is_euclidean() && fields.rows() != n_components_ * mass_.rows())) {
        throw InputError("InnerProduct: fields of {} values; expected {} at each of {} nodes",
                         fields.rows(), n_components_,
                         is_euclidean() ? fields.rows() / n_components_ : mass_.rows());
    }
}

MatrixX InnerProduct::apply(const MatrixX& fields) const {
    check(fields);
    if (is_euclidean()) {
        return fields;
    }
    return by_fields(mass_ * by_nodes(fields, n_components_), n_components_);
}

MatrixX InnerProduct::to_euclidean(const MatrixX& fields) const {
    check(fields);
    if (is_euclidean()) {
        return fields;
    }
    const auto& cholesky = factorization_->cholesky;
    const MatrixX permuted = cholesky.permutationP() * by_nodes(fields, n_components_);
    return by_fields(cholesky.matrixU() * permuted, n_components_);
}

MatrixX InnerProduct::from_euclidean(const MatrixX& columns) const {
    check(columns);
    if (is_euclidean()) {
        return columns;
    }
    const auto& cholesky = factorization_->cholesky;
    const MatrixX solved = cholesky.matrixU().solve(by_nodes(columns, n_components_));
    return by_fields(cholesky.permutationPinv() * solved, n_components_);
}

VectorX InnerProduct::squared_norms(const MatrixX& fields) const {
    return apply(fields).cwiseProduct(fields).colwise().sum().transpose();
}

}  // namespace couture::rom
