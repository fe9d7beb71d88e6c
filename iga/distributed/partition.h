#pragma once

#include <functional>
#include <vector>

#include "iga/core/types.h"
#include "iga/distributed/element_box.h"

namespace couture::iga {

/// Shares elements out: part by part, the boxes of each, at most one per patch. By bisection along
/// the longest extent of what is left, patches cut at planes of elements, so that parts are compact
/// and their surfaces small.
///
/// @param n_elements  of each patch by direction
/// @param middle  where the middle of a box lies in space
/// @throws InputError  if there are fewer elements than parts
template <int d>
[[nodiscard]] std::vector<std::vector<ElementBox<d>>> partition(
    const std::vector<std::array<int, d>>& n_elements,
    const std::function<Vector3(const ElementBox<d>&)>& middle, int n_parts);

}  // namespace couture::iga
