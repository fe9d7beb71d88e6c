#pragma once

#include <utility>
#include <vector>

#include "iga/core/types.h"
#include "meshing/surface/surface_mesh.h"
#include "meshing/topology/pants_record.h"

namespace couture::meshing {

/// Lower and upper corner of the box around the faces of a surface.
[[nodiscard]] std::pair<Vector3, Vector3> surface_box(const SurfaceMesh& mesh);

/// Carries points of one member of a family over to another: by their boxes, and the weighted mean
/// of how much that misses the landmarks that both have.
class MemberWarp {
  public:
    /// @param mesh, landmarks  of the other member
    MemberWarp(const PantsRecord& from, const SurfaceMesh& mesh, const Landmarks& landmarks);

    [[nodiscard]] Vector3 operator()(const Vector3& x) const;

  private:
    [[nodiscard]] Vector3 by_box(const Vector3& x) const;
    void add(const Vector3& from, const Vector3& to);
    void add_curve(const std::vector<Vector3>& from, const std::vector<Vector3>& to,
                   bool is_closed);

    Vector3 low_;
    Vector3 to_low_ = Vector3::Zero();
    Vector3 scale_ = Vector3::Ones();
    std::vector<std::pair<Vector3, Vector3>> misses_;
};

}  // namespace couture::meshing
