#pragma once

#include <functional>

#include "iga/spline/patch.h"

namespace couture::iga {

/// Spline that takes the values of `function` at the Greville points of `space`.
///
/// @param function  from a parameter to `dimension` numbers
/// @return n_basis x dimension coefficients
template <int d>
[[nodiscard]] MatrixX interpolate(const TensorSpace<d>& space, int dimension,
                                  const std::function<VectorX(const Vector<d>&)>& function);

}  // namespace couture::iga
