#pragma once

#include <array>
#include <optional>
#include <vector>

#include "meshing/surface/cut_surface.h"

namespace couture::meshing {

/// A place in a triangle of a piece.
struct MapPoint {
    int face;
    /// Weights of the triangle's vertices, in its order; not negative, sum 1.
    Vector3 weights;
};

/// The inverse of a map to the plane: from parameters to the surface. Holds a tree of boxes, built
/// once; after the piece or its parameters change (map_line.h) make a new one.
class PlanarMap {
  public:
    /// @param surface     must outlive the map
    /// @param parameters  one per vertex; every triangle counter-clockwise
    PlanarMap(const CutSurface& surface, std::vector<Vector2> parameters);

    [[nodiscard]] const CutSurface& surface() const { return *surface_; }
    [[nodiscard]] const std::vector<Vector2>& parameters() const { return parameters_; }

    /// The triangle that contains a parameter point, by exact signs; of several (on an edge or at a
    /// vertex) the one with the smallest number. On an edge or at a vertex the weights of the
    /// others are zero.
    ///
    /// @param tolerance  a point outside the map but no farther away is moved to the nearest place
    ///                   of the map; unit of the parameters
    /// @return nothing for a point outside
    [[nodiscard]] std::optional<MapPoint> locate(const Vector2& point,
                                                 double tolerance = 0.0) const;

    /// Point of the surface, and parameters, of a place.
    [[nodiscard]] Vector3 point(const MapPoint& place) const;
    [[nodiscard]] Vector2 parameters_at(const MapPoint& place) const;

    /// The surface's point at parameters.
    ///
    /// @throws GeometryError  outside the map by more than 1e-12 of its size
    [[nodiscard]] Vector3 point_at(const Vector2& parameters) const;

  private:
    struct Box {
        Vector2 low;
        Vector2 high;
        // Of the faces in order_; a leaf has no boxes below it.
        int begin;
        int end;
        int left = -1;
        int right = -1;
    };
    int build(int begin, int end);

    const CutSurface* surface_;
    std::vector<Vector2> parameters_;
    std::vector<int> order_;
    std::vector<Box> boxes_;
};

/// Weights of a point of a counter-clockwise triangle; zero beside an edge that it lies on exactly,
/// sum 1.
[[nodiscard]] Vector3 barycentric_weights(const Vector2& point,
                                          const std::array<Vector2, 3>& triangle);

}  // namespace couture::meshing
