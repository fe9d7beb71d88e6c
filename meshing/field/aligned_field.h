#pragma once

#include <span>
#include <vector>

#include "meshing/field/direction_field.h"
#include "meshing/layout/embedded_layout.h"

namespace couture::meshing {

/// A change of the angle of a face's direction that is asked for.
struct AngleTarget {
    FaceHandle face;
    /// Radians; not to be reduced.
    double offset = 0.0;
    /// Not negative, next to 1 for the square of each connection angle; infinite: exactly.
    double weight = 0.0;
};

/// The field of the same topology whose curvature has the least sum of squares, with targets: some
/// angles held, others drawn by squares. One sparse Cholesky factorization. The mean of several
/// held offsets of a face is held. In components without targets the offsets' sum is zero.
///
/// @throws InputError  for a negative or undefined weight; SolverError
///
/// Source: [Maquart19] Eq. (4.13), [BommesZimmerKobbelt09]
[[nodiscard]] DirectionField align_field(const SurfaceMesh& mesh, DirectionField field,
                                         std::span<const AngleTarget> targets);

/// Offset to the nearest of a field's directions, for a vector in the plane of a face.
[[nodiscard]] double nearest_offset(const DirectionField& field, FaceHandle face, double angle);

/// Targets along principal directions, each by the direction of the field that is nearest:
///
///     weight = strength area (k_max - k_min)^2,
///
/// of the means over the face's vertices that are not on edges tagged as features, which does not
/// depend on the mesh or on the unit. Only for crosses; none where there is no such vertex or the
/// surface is bent the same in all directions.
[[nodiscard]] std::vector<AngleTarget> principal_targets(const SurfaceMesh& mesh,
                                                         const DirectionField& field,
                                                         double strength);

/// Targets along edges of feature curves and boundaries, held, each by the direction of the field
/// that is nearest.
///
/// @param is_feature  for each edge
[[nodiscard]] std::vector<AngleTarget> feature_targets(const SurfaceMesh& mesh,
                                                       const DirectionField& field,
                                                       const std::vector<bool>& is_feature);

}  // namespace couture::meshing
