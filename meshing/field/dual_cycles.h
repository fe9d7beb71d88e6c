#pragma once

#include <vector>

#include "meshing/surface/surface_mesh.h"

namespace couture::meshing {

/// A closed path from face to face.
struct DualCycle {
    /// Halfedges that it crosses, each from the face on its left to that on its right.
    std::vector<HalfedgeHandle> crossed;
    /// Its geodesic curvature kappa: how far it turns to the left, in radians.
    double curvature = 0.0;
};

/// Cycles that generate all others: what a direction field does along them is its topology.
struct DualCycles {
    /// Ascending.
    std::vector<VertexHandle> inner_vertices;
    /// Counter-clockwise around each of them: curvature 2 pi - K_v.
    std::vector<DualCycle> around_vertices;
    /// Along each boundary, the boundary on the right, in the order of `boundary_loops`: curvature
    /// sum (pi - theta_v).
    std::vector<DualCycle> along_boundaries;
    /// Two for each handle, simple.
    std::vector<DualCycle> generators;
};

/// Generators are closed by edges that are in neither of a spanning tree of the faces and one of
/// the vertices, in which each boundary counts as one. Sums around vertices less sums along
/// boundaries vanish in each component; there are no other relations.
///
/// Source: [Maquart19] Prop. 2.2, [CraneDesbrunSchroeder10]
[[nodiscard]] DualCycles make_dual_cycles(const SurfaceMesh& mesh);

/// How far a path turns to the left in the face that it enters from `before` and leaves over
/// `after`, in radians.
[[nodiscard]] double turn_between(const SurfaceMesh& mesh, HalfedgeHandle before,
                                  HalfedgeHandle after);

}  // namespace couture::meshing
