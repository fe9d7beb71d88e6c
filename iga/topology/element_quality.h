#pragma once

#include "iga/topology/cell_shape.h"
#include "iga/topology/multipatch.h"

namespace couture::iga {

/// Quality of elements by the scaled Jacobian and by the shape of the cell between their corners.
///
/// Scaled Jacobian: orientation * det J over the product of the lengths of its columns, in [-1, 1];
/// 1 for a box, 0 where the map is singular (a zero column counts as 0).
template <int d>
struct QualitySummary {
    double min_scaled_jacobian = 1.0;
    double mean_scaled_jacobian = 1.0;
    int worst_patch = 0;
    Vector<d> worst_xi = Vector<d>::Zero();
    /// Smallest at the elements' corners and at their Gauss points, apart.
    double min_at_corners = 1.0;
    double min_at_gauss_points = 1.0;
    /// Shape ratio S_r of the elements' corners, see `shape_ratio`: sqrt(d) at best; may be
    /// infinite, and the mean with it.
    double max_shape_ratio = 0.0;
    double mean_shape_ratio = 0.0;
    /// The element with the largest one: its patch and its middle.
    int worst_shape_ratio_patch = 0;
    Vector<d> worst_shape_ratio_xi = Vector<d>::Zero();
    /// Deviation Q_h of the corners' angles from right ones, in radians, see `angle_deviation`.
    double max_angle_deviation = 0.0;
    double mean_angle_deviation = 0.0;
};

/// Scaled Jacobian over the corners and the (degree + 1)^d Gauss points of all elements, shapes
/// over all elements.
///
/// @throws InputError  if a patch has more dimensions than parameters
template <int d>
[[nodiscard]] QualitySummary<d> element_quality(const MultiPatch<d>& multipatch);

/// J scaled as above, for one matrix.
template <int d>
[[nodiscard]] double scaled_jacobian(const Matrix<d>& J);

}  // namespace couture::iga
