#pragma once

#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "iga/linalg/block_matrix.h"

namespace couture::iga {

template <int d>
class Space;

/// A x = b with some unknowns held: rows and columns of fixed unknowns are left out, the solution
/// there is zero (prescribed values are moved to b beforehand).
struct LinearSystem {
    const BlockMatrix& matrix;
    /// n_unknowns flags, or empty.
    std::vector<char> is_fixed;
    /// n_unknowns x k: motions without energy (rigid-body modes), for multigrid; may be empty.
    MatrixX near_null_space;
    /// Space whose functions are the block rows, for fast_diagonalization; may be nothing. Read by
    /// `factorize` only.
    std::variant<std::monostate, const Space<2>*, const Space<3>*> space = {};
};

struct SolverOptions {
    /// "auto", "cholmod", "fast_diagonalization", "matrix_free" (the same where there is a matrix),
    /// "petsc" or "umfpack".
    std::string name = "auto";
    /// Largest accepted |b - A x| / |b|. A direct solver may also stop at the rounding of A x where
    /// that is larger, up to 1e-6, and says so in the report's note.
    double tolerance = 1e-10;
    int max_iterations = 10000;
    /// Options for PETSc, as on its command line ("-ksp_type cg -pc_type gamg").
    std::string petsc_options;
    /// Bytes that a factorization may take; 0: what the machine has free.
    std::size_t memory_limit = 0;
};

struct SolveReport {
    std::string solver;
    /// 0 for a direct solver without refinement steps.
    int iterations = 0;
    /// True relative residual |b - A x| / |b| over the free unknowns, the worst right-hand side.
    double residual = 0.0;
    /// Bytes of the factor or preconditioner, as far as known.
    std::size_t memory = 0;
    /// Why "auto" took this solver, or what it fell back from; may be empty.
    std::string note;
};

/// One linear solver: set up once, solve for many right-hand sides. The system's matrix must
/// outlive it.
class LinearSolver {
  public:
    virtual ~LinearSolver() = default;
    /// @throws SolverError  if the matrix is not positive definite (names the first unknown met),
    ///                      or the memory estimate exceeds the limit
    virtual void factorize(const LinearSystem& system) = 0;
    /// @param b  n_unknowns x n right-hand sides; entries of fixed unknowns are ignored
    /// @param x  filled, n_unknowns x n, zero at fixed unknowns
    /// @throws SolverError  if the true residual stays above the tolerance
    virtual SolveReport solve(const MatrixX& b, MatrixX& x) = 0;
};

/// @throws InputError  for an unknown name: lists those there are
[[nodiscard]] std::unique_ptr<LinearSolver> make_linear_solver(const SolverOptions& options);

/// Names that `make_linear_solver` takes, "auto" first.
[[nodiscard]] const std::vector<std::string>& linear_solver_names();

}  // namespace couture::iga
