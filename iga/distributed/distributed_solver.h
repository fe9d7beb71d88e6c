#pragma once

#include <functional>
#include <memory>

#include "iga/distributed/distributed_space.h"
#include "iga/linalg/sparse_solver.h"

namespace couture::iga {

/// This rank's share of A x = b, over the unknowns n_components * function + component of its
/// pieces: A is the sum of the ranks' shares.
struct DistributedSystem {
    const SharedNumbers& numbers;
    int n_components = 1;
    /// Integrals over the rank's elements.
    const BlockMatrix* matrix = nullptr;
    /// Flags, the same on every rank that has the unknown; or empty.
    std::vector<char> is_fixed;
    /// Unknowns x motions without energy; may be empty.
    MatrixX near_null_space;
    /// Added to the matrix, between free unknowns; null on all ranks: A is symmetric.
    const SparseMatrix* skew = nullptr;
};

/// A system whose matrix is not formed, preconditioned by one on coarser functions.
struct MatrixFreeLevels {
    /// The share times local unknowns.
    std::function<VectorX(const VectorX&)> multiply;
    /// Of the share: local unknowns.
    VectorX diagonal;
    /// With its matrix.
    DistributedSystem coarse;
    /// Local unknowns from local coarse ones, and its transpose. Where several ranks have a
    /// function their mean is taken.
    std::function<VectorX(const VectorX&)> prolong;
    std::function<VectorX(const VectorX&)> restrict;
};

/// Solves with PETSc on all ranks: conjugate gradients with GAMG, or what the options say.
class DistributedSolver {
  public:
    DistributedSolver(const Communicator& ranks, const SolverOptions& options);
    ~DistributedSolver();
    DistributedSolver(const DistributedSolver&) = delete;
    DistributedSolver& operator=(const DistributedSolver&) = delete;

    /// Assembles the ranks' shares into a matrix of which each rank holds the rows that it owns.
    /// The share is not needed afterwards.
    ///
    /// @throws SolverError, InputError  as `PetscKrylov`
    void factorize(const DistributedSystem& system);
    /// Two-level multigrid: Chebyshev with the diagonal on the operator, GAMG on the coarse matrix.
    /// `levels` must outlive this.
    void prepare(const DistributedSystem& system, const MatrixFreeLevels& levels);

    /// @param b  local rows, to be added over the ranks: unknowns x right-hand sides
    /// @param x  filled, local rows; zero at fixed unknowns
    SolveReport solve(const MatrixX& b, MatrixX& x);

  private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace couture::iga
