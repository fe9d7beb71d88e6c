#pragma once

#include <array>
#include <optional>

#include "iga/topology/multipatch.h"

namespace couture::iga {

/// The multipatch of B-splines that runs through the points of `multipatch` at its own Greville
/// points: no weights, and any degree, also one below the geometry's. The error falls with
/// h^(degree + 1); what the functions contain, planes above all, is reproduced. Degree 1 has its
/// control points on the original.
///
/// Elements are those of `refine`: each of the geometry's is cut into ceil(n_elements / present
/// ones) equal parts, and further until neighbours conform. Functions are C^(degree - 1), at the
/// geometry's breakpoints no smoother than the geometry. Interfaces and sets are kept; control
/// points that patches share are equal to the last bit.
///
/// @param degree  1 to `max_degree`; nothing: the geometry's
/// @param n_elements  per direction, at least; nothing: the geometry's
/// @throws InputError  if the degree or a number of elements is out of range
///
/// Source: [deBoor01] Ch. XIII.
template <int d>
[[nodiscard]] MultiPatch<d> interpolate(const MultiPatch<d>& multipatch, std::optional<int> degree,
                                        std::optional<std::array<int, d>> n_elements);

}  // namespace couture::iga
