#pragma once

#include <memory>
#include <vector>

#include "iga/spline/point_inversion.h"
#include "meshing/volume/boundary_features.h"

namespace couture::meshing {

/// Directions in which control points may move without leaving the boundary, to first order.
class TangentFrames {
  public:
    /// All points free.
    explicit TangentFrames(int n_points)
        : freedom_(n_points, Freedom::interior), axes_(MatrixX::Zero(3, n_points)) {}

    /// @param axis  unit normal of a face, or unit tangent of a curve
    void set(int point, Freedom freedom, const Vector3& axis);
    /// Takes out of each column what the point must not do.
    void project(Eigen::Ref<MatrixX> columns) const;

  private:
    std::vector<Freedom> freedom_;
    MatrixX axes_;
};

/// Keeps the boundary of a deformed body while its control points slide: the body's faces and
/// feature curves as they were, and new control points put back onto them.
///
/// In plane faces and on straight curves (all control points within 1e-10 of their size) every
/// position in the plane or on the line is exact. Elsewhere the boundary is evaluated at the
/// Greville points, these move to the nearest points of the old face or curve, and splines (with
/// their weights kept) interpolate them, curves first.
class BoundarySlide {
  public:
    BoundarySlide(const iga::MultiPatch<3>& deformed, const BoundaryFeatures& features);
    BoundarySlide(BoundarySlide&&) noexcept;
    BoundarySlide& operator=(BoundarySlide&&) noexcept;
    ~BoundarySlide();

    /// Whether a control point lies on a curved face or curve.
    [[nodiscard]] bool is_curved(int dof) const { return is_curved_[dof]; }
    [[nodiscard]] bool has_curved() const;
    /// @param points  control points of the whole body, 3 x n_dofs
    [[nodiscard]] TangentFrames frames(const MatrixX& points) const;
    /// The same with the boundary put back onto the old one; inner points stay.
    [[nodiscard]] MatrixX retracted(const MatrixX& points) const;
    /// Largest distance of the boundary of `points` from the old one, sampled on curved faces and
    /// curves at `n_samples` places per element and direction.
    [[nodiscard]] double distance(const MatrixX& points, int n_samples) const;

  private:
    struct Side;
    struct Edge;
    struct OldFace;
    struct OldCurve;

    std::vector<bool> is_curved_;
    std::vector<Side> sides_;
    std::vector<Edge> edges_;
    std::vector<OldFace> old_faces_;
    std::vector<OldCurve> old_curves_;
    std::vector<int> feature_;
    std::vector<Freedom> freedom_;
};

}  // namespace couture::meshing
