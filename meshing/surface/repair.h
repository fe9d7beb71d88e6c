#pragma once

#include <span>
#include <vector>

#include "meshing/surface/surface_mesh.h"

namespace couture::meshing {

/// Where something was found or changed: triangles by their numbers, and a position in space.
struct SurfacePlace {
    std::vector<int> triangles;
    Vector3 position = Vector3::Zero();
};

/// What `repair_surface` did. Places are the first ten each; triangles by their numbers in what was
/// given.
struct RepairReport {
    /// Points that became one with an equal one before them.
    int n_merged = 0;
    /// Triangles in which a point stands twice.
    int n_degenerate = 0;
    std::vector<SurfacePlace> degenerate;
    /// Triangles with the same three vertices as another.
    int n_duplicates = 0;
    std::vector<SurfacePlace> duplicates;
    /// Points that no triangle has, beyond those that were merged.
    int n_unused = 0;
    /// Triangles turned round to run as their neighbours do.
    int n_turned = 0;
    std::vector<SurfacePlace> turned;

    /// Whether triangles or points are no longer those that were given; unused points do not count.
    [[nodiscard]] bool has_changed() const {
        return n_merged + n_degenerate + n_duplicates + n_turned > 0;
    }
};

struct RepairedSurface {
    TriangleSoup soup;
    RepairReport report;
    /// For each triangle its number in what was given.
    std::vector<int> source;
    /// All triangles that were turned, by their numbers now, ascending.
    std::vector<int> turned;
};

/// What is safe to repair without asking: no place of the surface moves. In this order:
/// - points that are exactly equal become one (0 and -0 are equal);
/// - triangles in which a point then stands twice are dropped;
/// - of triangles with the same three vertices that run the same way the first one stays. If some
///   run the other way, the first one stays where an odd number of other triangles meets at most
///   of its three edges (it closes the surface there), and none elsewhere: two sheets back to back
///   enclose nothing, as between two blocks that share a wall;
/// - points of no triangle are dropped;
/// - the triangles of each component, taken across edges of two triangles, are turned to run
///   alike: as most of them do; as the first does if both ways are equally frequent. A component
///   that cannot be oriented (Moebius strip, Klein bottle) is left as it is: `check_solid` names
///   the edges.
/// O(n log n).
///
/// @throws InputError     for vertex numbers that do not exist, and coordinates that are not finite
/// @throws GeometryError  if no triangle is left
[[nodiscard]] RepairedSurface repair_surface(const TriangleSoup& soup);

/// For each point the number of the first one that is equal to it. O(n log n).
[[nodiscard]] std::vector<int> first_equal_points(std::span<const Vector3> points);

/// Drops triangles in which a vertex stands twice, and of those with the same three vertices all
/// but what `repair_surface` keeps; counts and places go to the report.
///
/// @return for each triangle left its number before
std::vector<int> drop_bad_triangles(TriangleSoup& soup, RepairReport& report);

/// Turns triangles as `repair_surface` does.
///
/// @return the triangles that were turned, ascending
std::vector<int> orient_alike(TriangleSoup& soup);

[[nodiscard]] Vector3 centroid(const TriangleSoup& soup, int triangle);

}  // namespace couture::meshing
