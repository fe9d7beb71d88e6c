#pragma once

#include <map>
#include <string>

#include "iga/assembly/constraints.h"
#include "iga/linalg/block_matrix.h"

namespace couture::iga {

/// Unknowns n_components * dof + component from coefficients n_dofs x n_components, and back.
[[nodiscard]] VectorX flatten(const MatrixX& coefficients);
[[nodiscard]] MatrixX unflatten(const VectorX& unknowns, int n_components);

/// Adds a symmetric matrix over the unknowns, both triangles given, whose pattern lies within that
/// of `matrix`.
void add_symmetric(BlockMatrix& matrix, const SparseMatrix& addition);

/// Turns rows and columns of functions with a frame of their own.
template <int d>
void rotate_to_frames(BlockMatrix& matrix, const Constraints<d>& constraints);

/// Sum over the functions, 3 components.
[[nodiscard]] Vector3 sum_of_components(const MatrixX& forces);

/// Force on the body at each support set, each held direction to the support that holds it.
///
/// @param residual  internal minus external forces over the unknowns, in the frames
template <int d>
[[nodiscard]] std::map<std::string, Vector3> support_reactions(const Problem& problem,
                                                               const Constraints<d>& constraints,
                                                               const VectorX& residual);

}  // namespace couture::iga
