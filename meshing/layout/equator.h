#pragma once

#include "meshing/surface/surface_curves.h"
#include "meshing/surface/surface_mesh.h"

namespace couture::meshing {

/// A closed edge path that divides a closed surface of genus 0 into two like halves: near the
/// longest of its sections with the plane through its centre of area across the longest of its
/// principal axes. The mesh is refined where the path needs room.
///
/// @throws TopologyError  as trace_loop
[[nodiscard]] SurfaceCurve trace_equator(SurfaceMesh& mesh);

}  // namespace couture::meshing
