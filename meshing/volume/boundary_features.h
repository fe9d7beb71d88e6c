#pragma once

#include <numbers>
#include <string>
#include <vector>

#include "iga/topology/dof_map.h"
#include "iga/topology/multipatch.h"

namespace couture::meshing {

/// What a control point may do without changing the shape of the body.
enum class Freedom : signed char {
    fixed,  ///< corners, collapsed sides and edges, named edges and corners inside the body
    curve,  ///< slides along a feature curve
    face,   ///< slides within a face
    interior
};

/// Faces, feature curves and corners of a body, found once on its initial geometry and kept, as
/// sides and edges of patches, for all deformed states.
///
/// Faces are connected outer sides without a feature edge between them; inner sides of a boundary
/// set make faces too. Feature edges are edges of patches on faces whose two sides meet at more
/// than `feature_angle` somewhere, belong to different boundary sets, or that are more or fewer
/// than two, and edges named in a set. Curves are feature edges joined at vertices where just two
/// of them meet, with the same names, at less than `feature_angle`; all other ends are corners.
class BoundaryFeatures {
  public:
    /// @param feature_angle  between outward normals, and between tangents of a curve; radians in
    ///                       (0, pi)
    /// @throws InputError  if the angle is out of range or patches are not in space
    explicit BoundaryFeatures(const iga::MultiPatch<3>& initial,
                              double feature_angle = std::numbers::pi / 6.0);

    [[nodiscard]] const std::string& signature() const { return signature_; }
    /// The body's control points, shared ones once.
    [[nodiscard]] const iga::DofMap& dofs() const { return dofs_; }
    [[nodiscard]] Freedom freedom(int dof) const { return freedom_[dof]; }
    /// Face or curve that the point belongs to; of no meaning for others.
    [[nodiscard]] int feature(int dof) const { return feature_[dof]; }
    /// Sides of each face, inner ones once.
    [[nodiscard]] const std::vector<std::vector<iga::PatchEntity<3>>>& faces() const {
        return faces_;
    }
    /// Edges of each feature curve, each once.
    [[nodiscard]] const std::vector<std::vector<iga::PatchEntity<3>>>& curves() const {
        return curves_;
    }
    /// Numbers of the control points at corners, increasing.
    [[nodiscard]] const std::vector<int>& corners() const { return corners_; }
    /// Control points of elements at re-entrant feature edges, those around which the body fills
    /// more than a half: by number.
    [[nodiscard]] bool is_near_reentrant_edge(int dof) const { return near_reentrant_[dof]; }
    /// +1, or -1 for a left-handed patch.
    [[nodiscard]] int orientation(int patch) const { return orientations_[patch]; }
    /// Numbers of the control points on an entity, first free direction fastest.
    [[nodiscard]] std::vector<int> dofs_on(const iga::MultiPatch<3>& geometry,
                                           const iga::PatchEntity<3>& entity) const;

  private:
    void find_near_reentrant(const iga::MultiPatch<3>& geometry, const std::vector<bool>& on_edge);

    std::string signature_;
    iga::DofMap dofs_;
    std::vector<Freedom> freedom_;
    std::vector<int> feature_;
    std::vector<std::vector<iga::PatchEntity<3>>> faces_;
    std::vector<std::vector<iga::PatchEntity<3>>> curves_;
    std::vector<int> corners_;
    std::vector<bool> near_reentrant_;
    std::vector<int> orientations_;
};

}  // namespace couture::meshing
