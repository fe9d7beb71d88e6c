#pragma once

#include <optional>

#include "meshing/field/direction_field.h"
#include "meshing/layout/layout_samples.h"
#include "meshing/surface/quad_grid.h"
#include "meshing/surface/surface_mesh.h"

namespace couture::meshing {

/// How good a quad mesh is, and how near to the surface that it samples.
struct QuadQuality {
    /// Of the corners of quads, in radians.
    double smallest_angle = 0.0;
    double largest_angle = 0.0;
    /// Longest over shortest edge of a quad: the largest, and the mean.
    double largest_edge_ratio = 0.0;
    double mean_edge_ratio = 0.0;
    /// Of each quad the least of its corners: the sine of the angle, negative where the corner
    /// turns against the quad's normal (the cross product of its diagonals).
    double smallest_scaled_jacobian = 0.0;
    double mean_scaled_jacobian = 0.0;
    /// Two-sided distance between the surface and the quads, each as two triangles, over the
    /// diagonal of the surface's box: sampled at the vertices and centres of both.
    double hausdorff_distance = 0.0;
};

/// @throws InputError  if there is no quad or no face
///
/// Source: [Knupp01] for the scaled Jacobian.
[[nodiscard]] QuadQuality quad_quality(const QuadMesh& quads, const SurfaceMesh& mesh);

/// A corner of a cell that turns against the surface.
struct TurnedCorner {
    /// Of the layout.
    int quad = -1;
    Vector3 place = Vector3::Zero();
};

/// The worst of the corners of a grid's cells that turn against the surface, with the normal of the
/// face nearest to the middle of the cell: that where the sine of the angle is least; nothing if
/// none does.
[[nodiscard]] std::optional<TurnedCorner> worst_turned_corner(const LayoutSamples& samples,
                                                              const SurfaceMesh& mesh);

/// Mean angle in [0, pi/4], weighted by area, between the directions of a grid's cells, from the
/// middle of a side to that of the opposite one, and the nearest direction of a cross field in the
/// face nearest to the cell's middle.
[[nodiscard]] double mean_angle_to_field(const LayoutSamples& samples, const SurfaceMesh& mesh,
                                         const DirectionField& field);

}  // namespace couture::meshing
