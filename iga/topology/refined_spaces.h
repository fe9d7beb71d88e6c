#pragma once

#include "iga/topology/multipatch.h"

namespace couture::iga {

/// Functions of every patch after `refine(MultiPatch)`.
///
/// @throws InputError  if a degree is below the geometry's
template <int d>
[[nodiscard]] std::vector<TensorSpace<d>> refined_spaces(
    const MultiPatch<d>& multipatch, std::optional<int> degree,
    std::optional<std::array<int, d>> n_elements);

}  // namespace couture::iga
