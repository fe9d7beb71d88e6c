#pragma once

#include <vector>

#include "iga/core/types.h"
#include "meshing/surface/surface_mesh.h"

namespace couture::meshing {

/// A frame in the plane of each face: x along its first edge (mesh.halfedge_handle(face)), y a
/// quarter turn counter-clockwise of it seen from outside.
class FaceFrames {
  public:
    explicit FaceFrames(const SurfaceMesh& mesh);

    /// Angle of a halfedge in the frame of the face on its left, in radians.
    [[nodiscard]] double angle(HalfedgeHandle h) const { return angles_[h.idx()]; }
    /// kappa_ij in (-pi, pi]: a direction at angle alpha in the face on the left of an inner
    /// halfedge is parallel to the one at angle alpha + kappa_ij in the face on its right.
    ///
    /// Source: [Maquart19] Eq. (4.1)
    [[nodiscard]] double rotation(HalfedgeHandle h) const { return rotations_[h.idx()]; }
    /// Unit vector at an angle in the frame of a face.
    [[nodiscard]] Vector3 direction(FaceHandle face, double angle) const;
    /// Angle of a vector's part in the plane of a face.
    [[nodiscard]] double angle_of(FaceHandle face, const Vector3& vector) const;

  private:
    std::vector<double> angles_;
    std::vector<double> rotations_;
    std::vector<Vector3> x_;
    std::vector<Vector3> y_;
};

}  // namespace couture::meshing
