#pragma once

#include "iga/topology/multipatch.h"

namespace couture::iga {

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
};

/// Over the corners and the (degree + 1)^d Gauss points of all elements.
template <int d>
[[nodiscard]] QualitySummary<d> element_quality(const MultiPatch<d>& multipatch);

/// J scaled as above, for one matrix.
template <int d>
[[nodiscard]] double scaled_jacobian(const Matrix<d>& J);

}  // namespace couture::iga
