#pragma once

#include "iga/linalg/sparse_solver.h"

namespace couture::iga {

/// Checks sizes and that every row has its diagonal block.
///
/// @param solver  name that messages begin with
/// @throws InputError  naming the first thing that is wrong with its values
void check_system(const LinearSystem& system, const std::string& solver);

/// @throws InputError  if `b` has the wrong number of rows or an entry that is not finite
void check_right_hand_side(const BlockMatrix& matrix, const MatrixX& b, const std::string& solver);

/// b - A x with zeros at fixed unknowns; x must be zero there.
[[nodiscard]] MatrixX residual(const BlockMatrix& matrix, const std::vector<char>& is_fixed,
                               const MatrixX& b, const MatrixX& x);

/// `b` with zeros at fixed unknowns.
[[nodiscard]] MatrixX free_part(const std::vector<char>& is_fixed, const MatrixX& b);

/// Largest |r_k| / |b_k| over the columns k; columns with b_k = 0 and r_k = 0 count as 0.
[[nodiscard]] double worst_ratio(const MatrixX& r, const MatrixX& b);

/// eps | |A| |x_k| | / |b_k| over the free unknowns, the largest of the columns k: what rounding x
/// and the products of A x to double precision may leave of |b - A x| / |b|. Residuals no larger
/// than that can't be made smaller.
[[nodiscard]] double rounding_ratio(const BlockMatrix& matrix, const std::vector<char>& is_fixed,
                                    const MatrixX& b, const MatrixX& x);

/// Orthonormal basis of the columns' span: n x rank.
[[nodiscard]] MatrixX orthonormal_basis(const MatrixX& columns);

/// Number of independent motions of the near null space that no fixed unknown holds and that A
/// gives no energy: more than 0 means that the system is singular.
[[nodiscard]] int n_unconstrained_motions(const LinearSystem& system);

/// @throws SolverError  if motions are unconstrained: says how many
void check_constrained(const LinearSystem& system, const std::string& solver);

/// "unknown 17 (component 2 of block row 5)".
[[nodiscard]] std::string describe_unknown(const BlockMatrix& matrix, int unknown);

}  // namespace couture::iga
