#pragma once

#include <functional>
#include <memory>

#include "iga/linalg/coarse_space.h"
#include "iga/linalg/patch_preconditioner.h"
#include "iga/linalg/sparse_solver.h"

namespace couture::iga {

/// What the preconditioner must know of a matrix A that is not assembled.
struct MatrixFreeParts {
    int block_size = 1;
    /// n_unknowns flags.
    std::vector<char> is_fixed;
    /// As in `LinearSystem`.
    MatrixX near_null_space;
    /// Of each patch one per component: see `patch_coefficients`.
    std::vector<std::vector<PatchCoefficients>> coefficients;
    /// Of A.
    VectorX diagonal;
    /// Blocks of A between some functions (ascending), upper triangle.
    std::function<BlockMatrix(const std::vector<int>& functions)> submatrix;
    /// What P^T A P of coarse functions P is spectrally equivalent to, upper triangle.
    std::function<BlockMatrix(const CoarseFunctions&)> coarse_matrix;
};

/// Symmetric positive definite approximation of A^-1, a sum of three: patches and their interfaces
/// by fast diagonalization, the wire basket (functions where interfaces meet) by a factorization of
/// its part of A, and multilinear functions on a coarse grid.
class FastDiagonalization {
  public:
    /// @throws InputError  if the system has no space
    explicit FastDiagonalization(const LinearSystem& system);
    template <int d>
    FastDiagonalization(const Space<d>& space, const MatrixFreeParts& parts);

    /// @param r  zero at fixed unknowns
    [[nodiscard]] VectorX apply(const VectorX& r) const;
    [[nodiscard]] std::size_t memory() const;

  private:
    /// @param matrix  of the functions with these numbers; empty: of all
    void make_wire_basket(const BlockMatrix& matrix, const std::vector<char>& is_fixed,
                          const PatchStructure& structure, const std::vector<int>& functions);

    std::unique_ptr<PatchPreconditioner> patches_;
    std::unique_ptr<CoarseSpace> coarse_;
    /// Unknowns of the wire basket that are free, their matrix and its factorization.
    std::vector<int> wire_unknowns_;
    std::unique_ptr<BlockMatrix> wire_matrix_;
    std::unique_ptr<LinearSolver> wire_solver_;
};

/// Conjugate gradients with FastDiagonalization: iterations hardly depend on the number of elements
/// and the degree, memory is little more than that of A.
///
/// Source: [SangalliTani16] for one patch and one component.
[[nodiscard]] std::unique_ptr<LinearSolver> make_fast_diagonalization_solver(
    const SolverOptions& options);

}  // namespace couture::iga
