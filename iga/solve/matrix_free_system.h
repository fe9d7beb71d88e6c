#pragma once

#include <memory>
#include <optional>

#include "iga/assembly/constraints.h"
#include "iga/assembly/form_operator.h"
#include "iga/linalg/fast_diagonalization.h"

namespace couture::iga {

/// A symmetric system whose matrix is never formed: the form by sum factorization, a sparse matrix
/// that is added (foundations), and the frames of the constraints. Solved by conjugate gradients
/// with FastDiagonalization.
template <int d>
class MatrixFreeSystem {
  public:
    /// @param space  must outlive this
    /// @param addition  symmetric, both triangles, over unknowns along the axes; may be empty
    /// @throws GeometryError  for a folded patch: patch, place, value
    MatrixFreeSystem(const Space<d>& space, BilinearForm<d> form, SparseMatrix addition,
                     const Constraints<d>& constraints, std::optional<int> n_gauss_points = {});

    /// A u in the frames, column by column.
    [[nodiscard]] MatrixX operator*(const MatrixX& u) const;

    /// Sets up the preconditioner. @param near_null_space  as in `LinearSystem`, in the frames
    void prepare(const MatrixX& near_null_space);
    /// Largest entry of the diagonal, after `prepare`.
    [[nodiscard]] double scale() const { return scale_; }

    /// Solves for columns; x is zero at fixed unknowns.
    ///
    /// @throws NotPositiveDefinite, SolverError  as `LinearSolver`
    [[nodiscard]] SolveReport solve(const MatrixX& b, const SolverOptions& options,
                                    MatrixX& x) const;

    /// Bytes of the operator and the preconditioner.
    [[nodiscard]] std::size_t memory() const;

  private:
    [[nodiscard]] VectorX multiply(const VectorX& u) const;
    [[nodiscard]] VectorX diagonal() const;
    [[nodiscard]] BlockMatrix submatrix(const std::vector<int>& functions) const;
    [[nodiscard]] BlockMatrix coarse_matrix(const CoarseFunctions& functions,
                                            const VectorX& diagonal) const;

    const Space<d>& space_;
    Constraints<d> constraints_;
    FormOperator<d> form_;
    SparseMatrix addition_;
    std::optional<int> n_gauss_points_;
    double scale_ = 0.0;
    std::unique_ptr<FastDiagonalization> preconditioner_;
};

/// Bytes that the upper triangle of a space's matrix takes, from the numbers of neighbours of its
/// functions: an upper bound where patches meet.
template <int d>
[[nodiscard]] std::size_t matrix_memory(const Space<d>& space, int block_size);

}  // namespace couture::iga
