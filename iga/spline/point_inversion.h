#pragma once

#include <memory>
#include <optional>

#include "iga/spline/patch.h"

namespace couture::iga {

/// Parameter of the point of a patch that is nearest to a given one.
template <int d>
struct InvertedPoint {
    Vector<d> xi;
    /// Distance from the asked point to patch.point(xi).
    double distance = 0.0;
};

/// Finds parameters of points of one patch; keeps a tree of boxes around its Bezier elements.
/// Newton from the nearest samples of the boxes that may hold the nearest point; works for
/// left-handed and degenerate patches, and for curves and surfaces in space.
template <int d>
class PointInversion {
  public:
    explicit PointInversion(const Patch<d>& patch);
    PointInversion(PointInversion&&) noexcept;
    PointInversion& operator=(PointInversion&&) noexcept;
    ~PointInversion();

    /// The nearest point of the patch. Points outside give a positive distance.
    [[nodiscard]] InvertedPoint<d> nearest(const VectorX& point) const;
    /// The parameter of `point`, or nothing if it is farther than `tolerance` from the patch.
    [[nodiscard]] std::optional<Vector<d>> find(const VectorX& point, double tolerance) const;

  private:
    struct Tree;
    std::unique_ptr<Tree> tree_;
};

}  // namespace couture::iga
