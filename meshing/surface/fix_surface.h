#pragma once

#include "meshing/surface/repair.h"
#include "meshing/surface/surface_mesh.h"

namespace couture::meshing {

struct FixOptions {
    /// Points that are at most so far apart become one, relative to the diagonal of the bounding
    /// box; 0: none.
    double weld_distance = 1e-9;
    /// Triangles whose height is at most so large, relative to their longest side, go.
    double flatness = 1e-9;
    /// Whether every boundary loop is filled with triangles. A surface may be open on purpose.
    bool fills_holes = false;
};

/// What `fix_surface` did. Places are the first ten each, triangles by their numbers at that time.
struct FixReport {
    /// Points that became one with another that is near.
    int n_welded = 0;
    /// Longest distance by which a welded point moved.
    double largest_move = 0.0;
    /// Triangles without extent that went, by collapsing their shortest side or by dividing the
    /// triangle beyond their longest one.
    int n_flat_removed = 0;
    /// Such that could not go without changing what hangs together.
    int n_flat_left = 0;
    /// Copies of vertices made where fans of triangles touched at a vertex only.
    int n_split_vertices = 0;
    std::vector<SurfacePlace> split_vertices;
    /// Boundary loops that were filled, with how many triangles.
    int n_filled_holes = 0;
    int n_hole_triangles = 0;
    std::vector<SurfacePlace> filled_holes;
    /// Boundary loops for which no triangles were found.
    int n_open_holes = 0;
    /// What `repair_surface` did after welding.
    RepairReport repair;
};

struct FixedSurface {
    TriangleSoup soup;
    FixReport report;
};

/// Repairs that change the surface, so only where they were asked for: welds near points, drops
/// triangles without extent, gives fans that touch at a vertex a vertex each, fills holes, and
/// turns triangles to run alike. Edges with three or more triangles, several shells and
/// self-intersections stay: which part is meant is not for a program to guess, and CGAL's removal
/// of self-intersections is an experiment of its authors that may open the surface.
///
/// @param soup  as `repair_surface` leaves it
/// @throws InputError     for options that are negative or not finite, or not small (below 0.1)
/// @throws GeometryError  if no triangle is left
[[nodiscard]] FixedSurface fix_surface(const TriangleSoup& soup, const FixOptions& options = {});

/// Height over the longest side of a triangle, relative to that; 0 if all corners are one point.
[[nodiscard]] double relative_height(const TriangleSoup& soup, int triangle);

}  // namespace couture::meshing
