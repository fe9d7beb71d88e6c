#pragma once

#include <array>
#include <optional>
#include <vector>

#include "iga/core/types.h"

namespace couture::meshing {

/// The place of some triangles that is nearest to a point.
struct NearestPlace {
    /// Number of the triangle as it was given.
    int triangle = -1;
    /// Of its vertices, in its order; not negative, sum 1.
    Vector3 weights = Vector3::Zero();
    Vector3 point = Vector3::Zero();
    double squared_distance = 0.0;
};

/// Weights of the place of a triangle that is nearest to a point.
///
/// Source: [Ericson05] 5.1.5.
[[nodiscard]] Vector3 nearest_weights(const Vector3& point, const std::array<Vector3, 3>& triangle);

/// A tree of boxes over triangles in space that answers which place is nearest to a point, and what
/// a moving ball meets. Of equally near triangles that with the smaller number is taken.
class TriangleTree {
  public:
    /// @throws InputError  if there are none
    explicit TriangleTree(std::vector<std::array<Vector3, 3>> triangles);

    /// Its lowest and its highest corner.
    [[nodiscard]] std::array<Vector3, 2> box() const { return {boxes_[0].low, boxes_[0].high}; }
    [[nodiscard]] NearestPlace nearest(const Vector3& point) const;
    /// How far the centre of a ball moves along a line until the ball touches a triangle (see
    /// ball_contact); nothing if it never does.
    [[nodiscard]] std::optional<double> first_contact(const Vector3& start,
                                                      const Vector3& direction,
                                                      double radius) const;

  private:
    struct Box {
        Vector3 low;
        Vector3 high;
        // Of the triangles in order_; a leaf has no boxes below it.
        int begin;
        int end;
        int left = -1;
        int right = -1;
    };
    int build(int begin, int end);
    void search(int box, const Vector3& point, NearestPlace& best) const;

    std::vector<std::array<Vector3, 3>> triangles_;
    std::vector<int> order_;
    std::vector<Box> boxes_;
};

}  // namespace couture::meshing
