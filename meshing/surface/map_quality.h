#pragma once

#include <span>
#include <vector>

#include "meshing/surface/cut_surface.h"

namespace couture::meshing {

/// The triangles that do not turn counter-clockwise in a map to the plane (flipped or without
/// area), decided exactly; ascending.
///
/// @param parameters  one per vertex
[[nodiscard]] std::vector<int> flipped_triangles(const CutSurface& surface,
                                                 std::span<const Vector2> parameters);

/// How far a map to the plane is from an isometry up to scale. Triangles without area on the
/// surface are left out and counted.
struct MapDistortion {
    /// Area in the plane over area on the surface of a triangle, each divided by its total; 1 is
    /// best.
    double smallest_area_ratio = 1.0;
    double largest_area_ratio = 1.0;
    /// Change of a corner's angle in radians: the largest one, and the mean over all corners.
    double largest_angle_change = 0.0;
    double mean_angle_change = 0.0;
    int n_without_area = 0;
};

[[nodiscard]] MapDistortion map_distortion(const CutSurface& surface,
                                           std::span<const Vector2> parameters);

}  // namespace couture::meshing
