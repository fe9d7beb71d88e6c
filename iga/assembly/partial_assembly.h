#pragma once

#include <optional>
#include <vector>

#include "iga/assembly/bilinear_form.h"
#include "iga/linalg/coarse_space.h"
#include "iga/topology/space.h"

namespace couture::iga {

/// Blocks of a form's matrix between a few functions, upper triangle, row k for functions[k]: only
/// elements where they don't vanish are integrated.
///
/// @param functions  global numbers, ascending
/// @param n_gauss_points  per direction and element; nothing: degree + 1 of the space
template <int d>
[[nodiscard]] BlockMatrix assemble_between(const Space<d>& space, const BilinearForm<d>& form,
                                           const std::vector<int>& functions,
                                           std::optional<int> n_gauss_points = {});

/// Matrix of a form between multilinear functions, about: one point in the middle of each element
/// of the space. Upper triangle, rows are nodes.
template <int d>
[[nodiscard]] BlockMatrix assemble_multilinear(const Space<d>& space, const BilinearForm<d>& form,
                                               const CoarseFunctions& coarse);

}  // namespace couture::iga
