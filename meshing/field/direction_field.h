#pragma once

#include <vector>

#include "meshing/field/dual_tree.h"
#include "meshing/field/face_frames.h"
#include "meshing/field/field_topology.h"
#include "meshing/field/trivial_connection.h"
#include "meshing/surface/surface_mesh.h"

namespace couture::meshing {

/// In each face of a mesh `symmetry` directions, evenly spaced, and how those of neighbours belong
/// together.
struct DirectionField {
    int symmetry = 4;
    /// For each face the angle of one of them in its frame (FaceFrames), in radians.
    std::vector<double> angles;
    /// p_ij for each edge, i on the left of its halfedge 0 and j on its right: direction 0 of i,
    /// turned counter-clockwise by p_ij parts of a full turn, goes over into direction 0 of j. 0 on
    /// the boundary.
    ///
    /// Source: [Maquart19] Eq. (4.1)
    std::vector<int> period_jumps;
};

/// The field that a connection carries from the roots of a tree to all faces.
///
/// @param angle  at the roots
[[nodiscard]] DirectionField integrate_connection(const SurfaceMesh& mesh,
                                                  const Connection& connection, int symmetry,
                                                  double angle, const DualTree& tree);

/// The field of given angles that turns least from face to face.
[[nodiscard]] DirectionField field_of_angles(const SurfaceMesh& mesh, std::vector<double> angles,
                                             int symmetry);

/// How far a field turns against parallel transport: its connection.
///
/// Source: [Maquart19] Eq. (4.2)
[[nodiscard]] Connection field_curvature(const SurfaceMesh& mesh, const DirectionField& field);

/// The numbers that decide about a field.
[[nodiscard]] FieldTopology topology_of(const SurfaceMesh& mesh, const DualCycles& cycles,
                                        const DirectionField& field);

}  // namespace couture::meshing
