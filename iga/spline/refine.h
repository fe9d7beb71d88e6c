#pragma once

#include <span>

#include "iga/spline/patch.h"

namespace couture::iga {

/// A finer knot vector and the matrix that carries coefficients to it: fine = prolongation *
/// coarse.
struct Refinement {
    KnotVector knots;
    /// fine n_basis x coarse n_basis.
    SparseMatrix prolongation;
};

/// Inserts knots (with repetition) into `knots`; functions are reproduced exactly.
///
/// @throws InputError  if a knot lies outside the open interval or would occur more than degree
///                     times
///
/// Source: [PieglTiller97] Sec. 5.3 (knot refinement).
[[nodiscard]] Refinement insert_knots(const KnotVector& knots, std::span<const double> new_knots);

/// Raises the degree by `n_times`; every interior knot is repeated `n_times` more, so that the
/// functions keep their continuity.
///
/// @throws InputError  if the degree would exceed `max_degree`
///
/// Source: [PieglTiller97] Sec. 5.5.
[[nodiscard]] Refinement elevate_degree(const KnotVector& knots, int n_times);

/// k-refinement: first the degree is raised to `degree`, then each element is split into
/// ceil(n_elements / current elements) equal parts, new knots simple.
///
/// @throws InputError  if `degree` is below the present one (splines can't be lowered exactly)
[[nodiscard]] Refinement refine(const KnotVector& knots, int degree, int n_elements);

/// The matrix from `coarse` to `fine`, which must contain its functions.
///
/// @throws InputError  if it does not (degree, a missing knot or a multiplicity is named)
[[nodiscard]] Refinement prolongation_to(const KnotVector& coarse, const KnotVector& fine);

/// The smallest knot vector that contains both; they must span the same interval.
[[nodiscard]] KnotVector common_refinement(const KnotVector& a, const KnotVector& b);

/// Applies one refinement per direction to the homogeneous control points: the map is unchanged.
template <int d>
[[nodiscard]] Patch<d> refine(const Patch<d>& patch, const std::array<Refinement, d>& directions);

/// The patch written in `space`, which must contain its own.
template <int d>
[[nodiscard]] Patch<d> refine_to(const Patch<d>& patch, const TensorSpace<d>& space);

/// Kronecker product of the directions' matrices applied to the columns of `coefficients`
/// (first direction fastest): prod(rows) x n from prod(columns) x n.
template <int d>
[[nodiscard]] MatrixX apply_kronecker(const std::array<SparseMatrix, d>& matrices,
                                      const MatrixX& coefficients);

}  // namespace couture::iga
