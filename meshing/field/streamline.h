#pragma once

#include <vector>

#include "meshing/field/direction_field.h"
#include "meshing/field/face_frames.h"
#include "meshing/surface/surface_mesh.h"

namespace couture::meshing {

/// Points of a streamline of a direction field: from the centroid of a face along one of its
/// directions, straight in each face, and over each edge on along the direction of the next face
/// that is nearest. It ends after `length`, at the boundary, at an edge that the field of the
/// next face turns back to, or after as many faces as the mesh has.
///
/// @param direction  any number counts round the face's directions
/// @return the centroid, points on edges, the end
[[nodiscard]] std::vector<Vector3> trace_streamline(const SurfaceMesh& mesh,
                                                    const FaceFrames& frames,
                                                    const DirectionField& field, FaceHandle face,
                                                    int direction, double length);

}  // namespace couture::meshing
