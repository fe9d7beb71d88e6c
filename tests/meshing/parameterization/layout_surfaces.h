#pragma once

#include <array>
#include <functional>
#include <vector>

#include "meshing/layout/embedded_layout.h"

namespace couture::meshing {

struct LaidOutSurface {
    SurfaceMesh mesh;
    EmbeddedLayout embedding;
};

/// A layout drawn with shortest edge paths as arcs, chords split; quads by flooding.
///
/// @param is_feature  of an arc, by its path
[[nodiscard]] LaidOutSurface lay_out(
    const TriangleSoup& soup, const std::vector<std::array<int, 4>>& quads,
    const std::vector<int>& vertices_of_nodes,
    const std::function<bool(const std::vector<Vector3>&)>& is_feature);

/// The surface of the cube [-1, 1]^3 with 2 n^2 triangles on each face, its points moved; one quad
/// for each face.
[[nodiscard]] LaidOutSurface make_cube_layout(
    int n, const std::function<Vector3(const Vector3&)>& move,
    const std::function<bool(const std::vector<Vector3>&)>& is_feature);

/// Unit sphere; its cube is seen from `centre`, |centre| < 1.
[[nodiscard]] LaidOutSurface make_sphere_layout(int n, const Vector3& centre);

/// Closed cylinder of radius 1, -1 <= z <= 1, with both circles as features; the nodes of the upper
/// one are turned.
[[nodiscard]] LaidOutSurface make_can_layout(int n, double turn);

/// A torus of radii 1 and 0.4 in `n_sections` parts along, four quads around each, 8 m x 4 m
/// vertices; sections start at the given vertices of the 8 m, turned by the given ones of the 4 m.
[[nodiscard]] LaidOutSurface make_torus_layout(int m, const std::vector<int>& sections,
                                               const std::vector<int>& turns);

/// Open tube of radius 1 and height 2, four quads around, with 4 m x m vertices inside; upright
/// arcs are straight or zigzags.
[[nodiscard]] LaidOutSurface make_tube_layout(int m, bool is_zigzag);

}  // namespace couture::meshing
