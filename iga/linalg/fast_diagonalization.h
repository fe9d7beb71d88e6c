#pragma once

#include <memory>

#include "iga/linalg/coarse_space.h"
#include "iga/linalg/patch_preconditioner.h"
#include "iga/linalg/sparse_solver.h"

namespace couture::iga {

/// Symmetric positive definite approximation of A^-1, a sum of three: patches and their interfaces
/// by fast diagonalization, the wire basket (functions where interfaces meet) by a factorization of
/// its part of A, and multilinear functions on a coarse grid.
class FastDiagonalization {
  public:
    /// @throws InputError  if the system has no space
    explicit FastDiagonalization(const LinearSystem& system);

    /// @param r  zero at fixed unknowns
    [[nodiscard]] VectorX apply(const VectorX& r) const;
    [[nodiscard]] std::size_t memory() const;

  private:
    void make_wire_basket(const BlockMatrix& matrix, const std::vector<char>& is_fixed,
                          const PatchStructure& structure);

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
