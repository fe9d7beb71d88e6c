#pragma once

#include <functional>

#include "iga/linalg/sparse_solver.h"

namespace couture::iga {

/// Solution of A x = b with a factorization, refined while that helps.
///
/// @param solver  name that messages begin with
/// @param is_fixed  n_unknowns flags or empty; x is zero there
/// @param apply_inverse  A^-1 times right-hand sides that are zero at fixed unknowns
/// @param diagnosis  of the factorization, for the message
/// @throws SolverError  if |b - A x| / |b| stays above the tolerance and is more than the rounding
///                      of A x
SolveReport solve_refined(const std::string& solver, const BlockMatrix& matrix,
                          const std::vector<char>& is_fixed, const MatrixX& b, double tolerance,
                          const std::function<MatrixX(const MatrixX&)>& apply_inverse,
                          const std::string& diagnosis, MatrixX& x);

}  // namespace couture::iga
