#pragma once

#include <array>
#include <span>

#include "iga/spline/patch.h"

namespace couture::iga {

/// Knots closer than this part of the parameter interval are taken as one, so that no refinement
/// makes slivers.
constexpr double knot_tolerance_of_span = 1e-12;

/// A finer knot vector and the matrix that carries coefficients to it: fine = prolongation *
/// coarse. Every row is a convex combination (numbers from 0 to 1 that sum to 1), so refining never
/// loses digits.
struct Refinement {
    KnotVector knots;
    /// fine n_basis x coarse n_basis.
    SparseMatrix prolongation;
};

/// Inserts knots (with repetition, in any order) into `knots`; functions are reproduced exactly.
///
/// A new knot within `knot_tolerance_of_span` of one that is there repeats that one.
///
/// @throws InputError  if a knot lies outside the open interval or would occur more than degree
///                     times
///
/// Source: [PieglTiller97] Sec. 5.3 (knot refinement); [Ramshaw89] for the blossoms used here.
[[nodiscard]] Refinement insert_knots(const KnotVector& knots, std::span<const double> new_knots);

/// Raises the degree by `n_times`; every interior knot is repeated `n_times` more, so that the
/// functions keep their continuity.
///
/// @throws InputError  if the degree would exceed `max_degree`
///
/// Source: [PieglTiller97] Sec. 5.5; [Ramshaw89]: the blossom of the raised degree is the mean of
/// the present one over all subsets of its arguments.
[[nodiscard]] Refinement elevate_degree(const KnotVector& knots, int n_times);

/// k-refinement: first the degree is raised to `degree`, then each element is split into
/// ceil(n_elements / current elements) equal parts, new knots simple. Elements whose parts would be
/// slivers stay whole.
///
/// @throws InputError  if `degree` is below the present one (splines can't be lowered exactly)
///                     or above `max_degree`, or if `n_elements` < 1
[[nodiscard]] Refinement refine(const KnotVector& knots, int degree, int n_elements);

/// The matrix from `coarse` to `fine`, which must contain its functions.
///
/// Knots need to agree within `knot_tolerance_of_span` only; those of `fine` hold.
///
/// @throws InputError  if it does not (degree, interval, a missing knot or a multiplicity is named)
[[nodiscard]] Refinement prolongation_to(const KnotVector& coarse, const KnotVector& fine);

/// The smallest knot vector that contains both; where knots agree within `knot_tolerance_of_span`,
/// those of `a` hold.
///
/// @throws InputError  if they do not span the same interval
[[nodiscard]] KnotVector common_refinement(const KnotVector& a, const KnotVector& b);

/// Applies one refinement per direction to the homogeneous control points: the map is unchanged.
///
/// @throws InputError  if a refinement starts from another number of functions
template <int d>
[[nodiscard]] Patch<d> refine(const Patch<d>& patch, const std::array<Refinement, d>& directions);

/// The patch written in `space`, which must contain its own.
template <int d>
[[nodiscard]] Patch<d> refine_to(const Patch<d>& patch, const TensorSpace<d>& space);

/// Kronecker product of the directions' matrices applied to the columns of `coefficients`
/// (first direction fastest): prod(rows) x n from prod(columns) x n.
///
/// @throws InputError  if the coefficients have another number of rows
template <int d>
[[nodiscard]] MatrixX apply_kronecker(const std::array<SparseMatrix, d>& matrices,
                                      const MatrixX& coefficients);

}  // namespace couture::iga
