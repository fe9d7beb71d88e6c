#pragma once

#include <limits>

#include "iga/core/types.h"

namespace couture::meshing {

/// What a ShapeEnergy measures.
struct ShapeMeasure {
    /// Exponent of the mean ratio: the larger, the more the worst count.
    int power = 2;
    /// Part of the shape ratio of the elements' corners beside the mean ratio, and its exponent.
    double shape_ratio_weight = 0.0;
    int shape_ratio_power = 2;
    /// 0: infinite for folded elements. Else det J is replaced by
    /// (det J + sqrt(det J^2 + (2 regularization size^3)^2)) / 2, finite for all, with the
    /// element's size (see ShapeEnergy::set_reference).
    double regularization = 0.0;
    /// Part of (d^2 + 1) / (2 r) beside the mean ratio, with d = det J over the element's size^3
    /// and r the regularised d: 1 at the element's size. The mean ratio alone does not see sizes,
    /// and samples that shrink to points cost a regularised one nothing.
    double size_weight = 0.0;
};

/// |J|^3 / (3 sqrt(3)): the size of an element to the third power.
[[nodiscard]] double element_size_cubed(const Matrix<3>& J);

/// 1 / mean ratio, negative where folded; 0 for a zero matrix.
///
/// @param orientation  +1, or -1 for left-handed elements
[[nodiscard]] double inverse_mean_ratio(const Matrix<3>& J, int orientation);

/// A small power, by squaring.
[[nodiscard]] double integer_power(double x, int power);

/// mu^power of one sample with its part of the size, and the derivative by J.
struct SampleEnergy {
    double value = std::numeric_limits<double>::infinity();
    Matrix<3> by_J = Matrix<3>::Zero();
};

/// @param size_cubed  of the element in the reference (see ShapeEnergy::set_reference)
[[nodiscard]] SampleEnergy sample_energy(const Matrix<3>& J, int orientation,
                                         const ShapeMeasure& measure, double size_cubed);

}  // namespace couture::meshing
