#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "meshing/surface/features.h"
#include "meshing/surface/surface_mesh.h"

namespace couture::meshing {

/// A plane face that closes a surface and can be taken off: its rim becomes a boundary loop.
struct Cap {
    std::string name;
    /// Number of the smooth face, see Features::regions.
    int region = -1;
};

/// A surface some of whose caps were taken off.
struct OpenedSurface {
    TriangleSoup soup;
    /// Of each vertex and triangle the number on the closed surface.
    std::vector<int> vertices;
    std::vector<int> triangles;
    /// For each vertex the cap whose rim it lies on, or -1.
    std::vector<int> cap_of_vertex;
};

/// Triangles that close the boundary loops of a surface.
struct ClosingCaps {
    /// Numbers below `n_vertices` are the surface's vertices, the others those of `points` behind
    /// them.
    std::vector<std::array<int, 3>> triangles;
    std::vector<Vector3> points;
    int n_vertices = 0;
};

/// The caps that were taken off a surface.
///
/// @param closed  what the surface was opened from
[[nodiscard]] ClosingCaps caps_of(const SurfaceMesh& closed, const OpenedSurface& opened);

/// Fills every boundary loop (see fill_loop).
///
/// @throws TopologyError  for a loop that can't be filled
[[nodiscard]] ClosingCaps fill_boundaries(const SurfaceMesh& surface);

/// The smooth face at the point of the surface that is nearest to x. O(n).
[[nodiscard]] int region_near(const SurfaceMesh& mesh, const Vector3& x);

/// Plane faces, bounded by one loop, whose outward normals differ by less than an angle from a
/// direction; ascending.
///
/// @param angle  radians
/// @throws InputError  if the direction has no length or is not finite
[[nodiscard]] std::vector<int> regions_facing(const Features& features, const Vector3& direction,
                                              double angle);

/// Takes caps off a surface.
///
/// @param mesh  with regions on its faces (detect_features, tag_features)
/// @throws InputError     for a region that does not exist or is named twice
/// @throws TopologyError  for a face that is not plane or has more than one boundary loop; for caps
///                        that touch each other or the boundary; if nothing but caps is left
[[nodiscard]] OpenedSurface open_caps(const SurfaceMesh& mesh, const Features& features,
                                      std::span<const Cap> caps);

/// Puts caps back on a surface that was opened, and perhaps refined since: its vertices and faces
/// keep their numbers, those of the caps come behind them.
///
/// @param caps  of the surface before it was refined; triangles at edges that were split since are
///              split too
/// @throws TopologyError  if caps and rims don't fit
[[nodiscard]] SurfaceMesh close_caps(const SurfaceMesh& opened, const ClosingCaps& caps);

}  // namespace couture::meshing
