#pragma once

#include <vector>

#include "iga/spline/tensor_space.h"

namespace couture::iga {

/// A B-spline or NURBS map from a d-dimensional parameter box into space: a curve (d = 1), a
/// surface (d = 2) or a volume (d = 3).
template <int d>
class Patch {
  public:
    /// @param control_points  n_basis x dimension, dimension from d to 3
    /// @param weights  n_basis positive numbers, or empty for a B-spline. All-equal weights are
    ///                 dropped.
    /// @throws InputError  when counts do not match, a number is not finite or a weight not
    ///                     positive
    Patch(TensorSpace<d> space, MatrixX control_points, VectorX weights = {});

    [[nodiscard]] const TensorSpace<d>& space() const { return space_; }
    [[nodiscard]] const KnotVector& knots(int direction) const { return space_.knots[direction]; }
    [[nodiscard]] const MatrixX& control_points() const { return control_points_; }
    [[nodiscard]] const VectorX& weights() const { return weights_; }
    [[nodiscard]] bool is_rational() const { return weights_.size() > 0; }
    /// Number of coordinates of a point.
    [[nodiscard]] int dimension() const { return static_cast<int>(control_points_.cols()); }
    /// Weights times control points, and the weights: n_basis x (dimension + 1).
    [[nodiscard]] MatrixX homogeneous() const;
    /// The patch with these rows, the inverse of `homogeneous`.
    [[nodiscard]] static Patch from_homogeneous(TensorSpace<d> space, const MatrixX& rows,
                                                bool is_rational);

    /// The point at xi. @throws InputError outside the parameter box
    [[nodiscard]] VectorX point(const Vector<d>& xi) const;
    /// dx_i / dxi_k: dimension x d.
    [[nodiscard]] MatrixX jacobian(const Vector<d>& xi) const;

  private:
    TensorSpace<d> space_;
    MatrixX control_points_;
    VectorX weights_;
};

using Curve = Patch<1>;
using Surface = Patch<2>;
using Volume = Patch<3>;

/// Non-zero functions of a tensor space, rational where weights are given, at one point.
template <int d>
struct PointBasis {
    /// Function numbers, prod(degree + 1), first direction fastest.
    std::vector<int> functions;
    VectorX values;
    /// d R_i / dxi_k: functions x d.
    Eigen::Matrix<double, Eigen::Dynamic, d> gradients;
};

/// @param weights  n_basis weights or empty
/// @throws InputError  if xi lies outside the parameter box
///
/// Source: [PieglTiller97] Eq. (4.2), (4.14).
template <int d>
[[nodiscard]] PointBasis<d> evaluate_basis(const TensorSpace<d>& space, const VectorX& weights,
                                           const Vector<d>& xi);

}  // namespace couture::iga
