#pragma once

#include <memory>

#include "iga/core/types.h"

namespace couture::rom {

/// The inner product of fields a^T W b that modes are orthonormal in.
///
/// Fields are vectors of n_nodes x n_components values, node by node. W is a mass matrix of
/// scalar functions on the reference member, used for each component: the L2 product there.
class InnerProduct {
  public:
    /// Euclidean.
    explicit InnerProduct(int n_components);
    /// @param mass  n_nodes x n_nodes, symmetric positive definite
    /// @throws SolverError  if it isn't
    InnerProduct(const SparseMatrix& mass, int n_components);

    [[nodiscard]] bool is_euclidean() const { return factorization_ == nullptr; }
    /// W fields. @param fields  n_nodes * n_components rows
    [[nodiscard]] MatrixX apply(const MatrixX& fields) const;
    /// Columns with the same products in the Euclidean sense: R fields, with W = R^T R.
    [[nodiscard]] MatrixX to_euclidean(const MatrixX& fields) const;
    /// The inverse of to_euclidean.
    [[nodiscard]] MatrixX from_euclidean(const MatrixX& columns) const;
    /// Of each field.
    [[nodiscard]] VectorX squared_norms(const MatrixX& fields) const;

  private:
    struct Factorization;

    void check(const MatrixX& fields) const;

    int n_components_;
    SparseMatrix mass_;
    std::shared_ptr<const Factorization> factorization_;
};

}  // namespace couture::rom
