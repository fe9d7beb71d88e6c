#pragma once

#include <functional>

#include "meshing/surface/surface_curves.h"
#include "meshing/surface/surface_mesh.h"

namespace couture::meshing {

/// Pulls a simple closed edge path tight: it becomes the shortest one within an annulus around
/// itself, and again, until no shorter one is found. Its isotopy class and direction stay; it
/// touches neither boundaries nor curves of the mesh.
///
/// @param curve   not marked on the mesh, off its boundaries and curves
/// @param radius  a length: the annulus holds what is as near to the path; what is nearer, where
///                that is none
/// @param factor  positive, on lengths at a vertex; taken as the mean over an edge
[[nodiscard]] SurfaceCurve tighten_loop(const SurfaceMesh& mesh, SurfaceCurve curve, double radius,
                                        const std::function<double(VertexHandle)>& factor);

}  // namespace couture::meshing
