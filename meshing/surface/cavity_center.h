#pragma once

#include <optional>

#include "meshing/surface/triangle_tree.h"

namespace couture::meshing {

/// A place in a cavity.
struct CavityPlace {
    Vector3 position = Vector3::Zero();
    /// From the wall.
    double distance = 0.0;
};

/// About the place inside a cavity that is farthest from its wall, by samples of the box and a
/// search around the best one. Inside is where at least three quarters of the directions meet the
/// wall, which may have openings and any defects.
///
/// @return nothing if no sample is inside
[[nodiscard]] std::optional<CavityPlace> find_cavity_center(const TriangleTree& wall);

/// Part of 200 directions, spread evenly, that meet the wall.
[[nodiscard]] double enclosed_part(const TriangleTree& wall, const Vector3& position);

}  // namespace couture::meshing
