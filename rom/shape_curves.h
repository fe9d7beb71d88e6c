#pragma once

#include <cstdint>

#include "rom/shape_analysis.h"

namespace couture::rom {

/// A measure of a model with its first 0, 1, 2, ... modes.
struct ShapeCurve {
    VectorX values;
    /// Standard errors of the values, which are means.
    VectorX errors;
};

/// Part of the population's variance that the first k modes hold: from 0 to 1, k = 0 .. n_modes.
///
/// Source: [Davies02] Sec. 4.4; 1 - the square of (1.14).
[[nodiscard]] VectorX compactness(const ShapeModel& model);

/// How far a member is from its projection onto k modes of all the others, root mean square over
/// points, mean over the members; k = 0 .. min(n_modes, n_members - 2). Members stay aligned as
/// they are in the model.
///
/// @throws InputError  for fewer than 3 members
///
/// Source: [Davies02] Sec. 4.4.
[[nodiscard]] ShapeCurve generalisation(const ShapeModel& model);

/// How far virtual members with k normally distributed coefficients are from the nearest member,
/// root mean square over points, mean over the virtual members; k = 0 .. n_modes.
///
/// @throws InputError  for fewer than 2 virtual members
///
/// Source: [Davies02] Sec. 4.4.
[[nodiscard]] ShapeCurve specificity(const ShapeModel& model, int n_virtual = 1000,
                                     std::uint64_t seed = 1);

}  // namespace couture::rom
