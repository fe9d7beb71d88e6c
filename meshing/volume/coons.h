#pragma once

#include "iga/spline/tensor_space.h"

namespace couture::meshing {

/// The control net with its inner rows replaced: transfinite interpolation (bilinear or trilinear
/// Coons) of the rows on its border, at the Greville abscissae. It is what the Coons patch of the
/// border's splines has in the same space.
///
/// @param net  n_basis rows, first direction fastest; any number of columns, also homogeneous
/// @throws InputError  if the net has another number of rows
///
/// Source: [PieglTiller97] Eq. (10.43) and its trivariate form.
template <int d>
[[nodiscard]] MatrixX fill_coons(const iga::TensorSpace<d>& space, MatrixX net);

/// Points on the straight line between two rows, at the Greville abscissae.
[[nodiscard]] MatrixX straight_net(const iga::KnotVector& knots, const MatrixX& first,
                                   const MatrixX& last);

}  // namespace couture::meshing
