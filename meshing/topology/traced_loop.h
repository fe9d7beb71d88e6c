#pragma once

#include <vector>

#include "meshing/surface/surface_curves.h"
#include "meshing/surface/surface_mesh.h"

namespace couture::meshing {

/// A closed polyline on or near a surface that a curve is to follow.
struct GuideLoop {
    /// At least three; the first one is not repeated at the end.
    std::vector<Vector3> points;
    /// Outward normals of the surface there, one for each point, or none: they tell the two sides
    /// of a thin wall apart.
    std::vector<Vector3> normals;
};

/// A simple closed edge path along a guide: through the vertices nearest to its points, then pulled
/// tight within an annulus around itself, so that its isotopy class stays. Lengths count
/// 1 + (d / width)^2 times at a distance d from the guide.
///
/// The path touches neither boundaries nor curves of the mesh, which is refined where it needs
/// room, and runs in the guide's direction. It is not marked.
///
/// @param width  a length
/// @throws InputError     for fewer than three points, a point that is not finite or lies farther
///                        from the surface than a tenth of its diagonal, or another number of
///                        normals
/// @throws TopologyError  if no such path exists without crossing other curves, or it shrinks to
///                        less than three vertices
[[nodiscard]] SurfaceCurve trace_loop(SurfaceMesh& mesh, const GuideLoop& guide, double width);

/// Distance from a point to a closed polyline.
[[nodiscard]] double distance_to_loop(const Vector3& x, const std::vector<Vector3>& loop);

}  // namespace couture::meshing
