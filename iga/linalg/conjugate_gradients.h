#pragma once

#include <functional>
#include <string>

#include "iga/linalg/sparse_solver.h"

namespace couture::iga {

struct ConjugateGradientOptions {
    /// Largest accepted true |b - A x| / |b|.
    double tolerance = 1e-10;
    int max_iterations = 10000;
    /// Given up when so many iterations have not made the residual ten times smaller.
    int max_idle_iterations = 500;
};

/// Solves A x = b by preconditioned conjugate gradients; the recursive residual is replaced by the
/// true one at the end, as often as that helps.
///
/// @param solver  name that messages begin with
/// @param A  product of a symmetric matrix and a vector
/// @param is_fixed  n_unknowns flags or empty; x is zero there
/// @param b  zero at fixed unknowns
/// @param precondition  symmetric positive definite, zero at fixed unknowns
/// @param report  iterations and residual: the worse of those there and these
/// @throws NotPositiveDefinite  if A or the preconditioner shows that it is not
/// @throws SolverError  if the residual stays above the tolerance
///
/// Source: [NocedalWright06] Alg. 5.3.
[[nodiscard]] VectorX conjugate_gradients(
    const std::string& solver, const std::function<VectorX(const VectorX&)>& A,
    const std::vector<char>& is_fixed, const VectorX& b,
    const std::function<VectorX(const VectorX&)>& precondition,
    const ConjugateGradientOptions& options, SolveReport& report);

}  // namespace couture::iga
