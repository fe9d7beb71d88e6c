#pragma once

#include <array>
#include <vector>

#include "meshing/surface/planar_map.h"

namespace couture::meshing {

/// Quadrilaterals by vertex numbers.
struct QuadMesh {
    std::vector<Vector3> points;
    /// Counter-clockwise seen from outside.
    std::vector<std::array<int, 4>> quads;
};

struct QuadGridOptions {
    /// Quads in the first and the second direction of the parameters.
    int n_u = 8;
    int n_v = 8;
    /// Closed in that direction: the last row of points is the first one. Both sides of the
    /// rectangle are sampled, and must give the same points on the surface.
    bool is_closed_u = false;
    bool is_closed_v = false;
    /// Largest distance of two points that are to be one, over the diagonal of the grid's box.
    double weld_tolerance = 1e-9;
};

/// The images of the (n_u + 1) x (n_v + 1) points of a uniform grid over [low, high] in the plane
/// of a map, joined to quads; a surface that was cut to a rectangle is closed again where the
/// options say so.
///
/// Point (i, j) has number (number of columns) j + i, with n_u columns if closed in u, else
/// n_u + 1.
///
/// @throws InputError     for less than one quad in a direction (three if closed), or low not
///                        below high
/// @throws GeometryError  for a grid point outside the map, or sides that don't match
///
/// Source: [Maquart19] Fig. 2.14.
[[nodiscard]] QuadMesh extract_quad_grid(const PlanarMap& map, const Vector2& low,
                                         const Vector2& high, const QuadGridOptions& options);

}  // namespace couture::meshing
