#pragma once

#include <petscksp.h>

#include <functional>

#include "iga/linalg/sparse_solver.h"

namespace couture::iga {

/// A Krylov method of PETSc with its preconditioner: conjugate gradients with GAMG unless options
/// say otherwise (GMRES where the matrix is not symmetric). Works on what this process owns of
/// vectors; calls are collective over the matrix' processes.
class PetscKrylov {
  public:
    explicit PetscKrylov(const SolverOptions& options) : options_(options) {}
    ~PetscKrylov();
    PetscKrylov(const PetscKrylov&) = delete;
    PetscKrylov& operator=(const PetscKrylov&) = delete;

    /// @param A  shared, not copied
    /// @param prepare  called with the method before it reads its options; may be nothing
    /// @throws SolverError  with PETSc's message
    /// @throws InputError   for options that nothing reads
    void set_up(Mat A, bool is_symmetric, const std::function<void(KSP)>& prepare = {});

    /// Solves A x = b; restarts from the true residual where the recursive one has drifted.
    ///
    /// @param b  rows that this process owns
    /// @param is_fixed  flags of these rows: x is zero there; may be empty
    /// @param report  iterations and residual: the worse of those there and these
    /// @throws SolverError  if |b - A x| / |b| stays above the tolerance
    [[nodiscard]] VectorX solve(const VectorX& b, const std::vector<char>& is_fixed,
                                SolveReport& report);

    /// Options for the set-up of matrices and the like.
    [[nodiscard]] PetscOptions petsc_options();

  private:
    void release();
    [[nodiscard]] double residual(const VectorX& b, const VectorX& x, VectorX& r) const;
    [[nodiscard]] VectorX run(const VectorX& r, int max_iterations, double ratio, int& n_iterations,
                              KSPConvergedReason& reason);

    SolverOptions options_;
    PetscOptions petsc_options_ = nullptr;
    KSP ksp_ = nullptr;
};

using RowMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// All entries row by row, as PETSc reads them; rows and columns of fixed unknowns are those of the
/// identity, scaled like the rest.
///
/// @param is_fixed  n_unknowns flags or empty
[[nodiscard]] RowMatrix rows_for_petsc(const BlockMatrix& matrix,
                                       const std::vector<char>& is_fixed);

/// Gives A an orthonormal basis of motions without energy for multigrid.
///
/// @param columns  rows that this process owns; dependent ones are left out
void set_near_null_space(Mat A, const MatrixX& columns);

}  // namespace couture::iga
