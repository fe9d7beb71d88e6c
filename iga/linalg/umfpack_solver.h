#pragma once

#include "iga/linalg/sparse_solver.h"

namespace couture::iga {

/// LU factorization with pivoting: for matrices that are not symmetric, or symmetric but not
/// positive definite (tangents past a limit point). Takes more time and memory than Cholesky.
///
/// Source: [Davis04].
[[nodiscard]] std::unique_ptr<LinearSolver> make_umfpack_solver(const SolverOptions& options);

}  // namespace couture::iga
