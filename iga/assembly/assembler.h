#pragma once

#include <optional>

#include "iga/assembly/bilinear_form.h"
#include "iga/linalg/block_matrix.h"
#include "iga/topology/space.h"

namespace couture::iga {

/// The matrix of a symmetric form on all patches: upper triangle of n_components blocks. The same
/// bits for any number of threads.
///
/// @param n_gauss_points  per direction and element; nothing: degree + 1 of the space
/// @throws GeometryError  for a folded patch: patch, place, value
/// @throws SolverError    if the matrix would not fit into the machine's memory
template <int d>
[[nodiscard]] BlockMatrix assemble(const Space<d>& space, const BilinearForm<d>& form,
                                   std::optional<int> n_gauss_points = {});

/// The same into a matrix made by `make_pattern`, whose values are replaced.
template <int d>
void assemble_into(BlockMatrix& matrix, const Space<d>& space, const BilinearForm<d>& form,
                   std::optional<int> n_gauss_points = {});

/// Gauss points per direction of a patch: `n_gauss_points` or degree + 1.
template <int d>
[[nodiscard]] std::array<int, d> gauss_points(const TensorSpace<d>& space,
                                              std::optional<int> n_gauss_points);

}  // namespace couture::iga
