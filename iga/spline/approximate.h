#pragma once

#include <functional>

#include "iga/spline/patch.h"

namespace couture::iga {

/// Spline that takes the values of `function` at the Greville points of `space`; functions of the
/// space are reproduced. Costs O(n degree^2) per direction and line.
///
/// @param function  from a parameter to `dimension` numbers
/// @return n_basis x dimension coefficients
/// @throws InputError  if `function` returns another count or a number that is not finite
///
/// Source: [deBoor01] Ch. XIII.
template <int d>
[[nodiscard]] MatrixX interpolate(const TensorSpace<d>& space, int dimension,
                                  const std::function<VectorX(const Vector<d>&)>& function);

/// The same for values at hand. @param values  n_basis rows, in the order of the functions
template <int d>
[[nodiscard]] MatrixX interpolate(const TensorSpace<d>& space, const MatrixX& values);

/// Greville points of the functions, in their order.
template <int d>
[[nodiscard]] std::vector<Vector<d>> greville_points(const TensorSpace<d>& space);

}  // namespace couture::iga
