#pragma once

#include "iga/core/error.h"
#include "iga/linalg/sparse_solver.h"

namespace couture::iga {

/// The Cholesky factor needs more memory than is allowed.
class FactorTooLarge : public SolverError {
  public:
    using SolverError::SolverError;
};

/// A pivot of the Cholesky factor is not positive.
class NotPositiveDefinite : public SolverError {
  public:
    using SolverError::SolverError;
};

/// Supernodal Cholesky factorization A = L L^T. Nested dissection orders the graph of blocks; the
/// size of the factor is known before it is computed and compared with the memory limit. A matrix
/// with the same pattern and fixed unknowns as the one before is not ordered again.
///
/// Source: [ChenDavisHagerRajamanickam08].
[[nodiscard]] std::unique_ptr<LinearSolver> make_cholmod_solver(const SolverOptions& options);

}  // namespace couture::iga
