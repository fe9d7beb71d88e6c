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

/// Finds parameters of points of one patch; keeps a tree of boxes around its Bezier elements,
/// halved until they are nearly flat. Boxes are searched by growing distance, with Newton's method
/// inside each, until all others are farther than the point found; works for left-handed and
/// degenerate patches, and for curves and surfaces in space. Where several points are nearest, any
/// of them is returned. Safe to ask from many threads.
///
/// Source: [PieglTiller97] Sec. 6.1 for the equations; [NocedalWright06] Sec. 16.7 for the bounds.
template <int d>
class PointInversion {
  public:
    explicit PointInversion(const Patch<d>& patch);
    PointInversion(PointInversion&&) noexcept;
    PointInversion& operator=(PointInversion&&) noexcept;
    ~PointInversion();

    /// The nearest point of the patch. Points outside give a positive distance.
    ///
    /// @throws InputError  if `point` has another number of coordinates or is not finite
    [[nodiscard]] InvertedPoint<d> nearest(const VectorX& point) const;
    /// The parameter of `point`, or nothing if it is farther than `tolerance` from the patch.
    [[nodiscard]] std::optional<Vector<d>> find(const VectorX& point, double tolerance) const;

  private:
    struct Tree;
    std::unique_ptr<Tree> tree_;
};

}  // namespace couture::iga
