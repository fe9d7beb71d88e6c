#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "iga/spline/point_inversion.h"
#include "iga/topology/multipatch.h"

namespace couture::iga {

/// Where in which patch a point of space lies.
template <int d>
struct Location {
    int patch = 0;
    Vector<d> xi = Vector<d>::Zero();
};

/// Finds points in the body.
template <int d>
class Locator {
  public:
    explicit Locator(const MultiPatch<d>& geometry);
    /// The patch and parameter of a point; nothing if no patch is within `tolerance`.
    [[nodiscard]] std::optional<Location<d>> find(const Vector3& point, double tolerance) const;
    /// The nearest place of the body and its distance.
    [[nodiscard]] std::pair<Location<d>, double> nearest(const Vector3& point) const;
    /// The same for a point that is likely in `patch`: the others are searched only if it is not.
    [[nodiscard]] std::pair<Location<d>, double> nearest(const Vector3& point, int patch) const;

  private:
    std::vector<PointInversion<d>> patches_;
    int dimension_;
    double size_;
};

}  // namespace couture::iga
