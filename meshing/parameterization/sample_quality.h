#pragma once

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

}  // namespace couture::meshing
