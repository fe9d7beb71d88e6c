#pragma once

#include "meshing/surface/surface_mesh.h"

namespace couture::meshing {

/// Regular tetrahedron of edge length 1, oriented outwards.
[[nodiscard]] TriangleSoup make_tetrahedron();

/// Axis-parallel cube [0, 1]^3 with 2 n^2 triangles on each face.
[[nodiscard]] TriangleSoup make_cube(int n);

/// Square [0, 1]^2 in the plane z = 0, normal +z, 2 n^2 triangles.
[[nodiscard]] TriangleSoup make_square(int n);

/// Torus around the z axis, oriented outwards: n_around x n_tube x 2 triangles; vertex
/// n_tube i + j lies at angle 2 pi i / n_around around the axis, 2 pi j / n_tube in the tube.
[[nodiscard]] TriangleSoup make_torus(int n_around, int n_tube, double radius, double tube_radius);

/// Open cylinder around the z axis, 0 <= z <= length, oriented outwards, n_around x n_along x 2
/// triangles; vertex n_around i + j at height i length / n_along.
[[nodiscard]] TriangleSoup make_tube(int n_around, int n_along, double radius, double length);

/// Surface of `genus` square frames in a row along x (cubes of 1 x 1 x 1, each cube's face divided
/// n x n x 2), oriented outwards: a plate of (2 genus + 1) x 3 x 1 cubes with `genus` holes.
[[nodiscard]] TriangleSoup make_plate_with_holes(int genus, int n);

/// Both soups in one, unconnected.
[[nodiscard]] TriangleSoup join(const TriangleSoup& a, const TriangleSoup& b);

}  // namespace couture::meshing
