#pragma once

#include <array>
#include <vector>

#include "iga/core/types.h"
#include "meshing/surface/surface_mesh.h"

namespace couture::meshing {

/// A closed component of a boundary: the outside of a solid, or a cavity in it.
struct Shell {
    /// Triangle numbers, ascending.
    std::vector<int> triangles;
    /// Inside the shell, positive whichever way its triangles turn.
    double volume = 0.0;
    int genus = 0;
    bool is_cavity = false;
    /// Whether its triangles must be turned so that normals point out of the material.
    bool is_reversed = false;
};

/// One solid by its boundary.
struct Solid {
    /// The outer one first, then the cavities in the order of their smallest triangle.
    std::vector<Shell> shells;
    /// Outer volume minus cavities.
    double volume = 0.0;
    /// Euler characteristic of the volume: the sum of 1 - genus over its shells.
    int euler_characteristic = 0;
    /// Components, tunnels, cavities: 1, sum of genera, n_shells - 1.
    std::array<int, 3> betti{0, 0, 0};
};

/// The solid that closed triangles bound: one outer shell, all others cavities in it. Which shell
/// lies in which is told by winding numbers of some of its vertices.
///
/// @param soup  each component closed and consistently oriented, in either direction
/// @throws TopologyError  if a component is open or not consistently oriented (says at which edge),
///                        if parts touch at a vertex, if there are no triangles, if two shells are
///                        disjoint, if a shell lies in a cavity (two solids either way; with
///                        positions)
/// @throws GeometryError  if a shell encloses no volume, or if two shells cross or touch, as far as
///                        the vertices that are tried show it
///
/// Source: [Maquart19] section 6.1.3, Eq. (6.15): b1 = b0 + b2 - chi(boundary) / 2
[[nodiscard]] Solid make_solid(const TriangleSoup& soup);

/// A closed component among others.
struct NestedShell {
    /// `is_cavity` and `is_reversed` as if the shells around it bounded a solid with cavities,
    /// solids in these, and so on.
    Shell shell;
    /// How many shells are around it: 0 an outer one, 1 a cavity, 2 a solid in a cavity.
    int depth = 0;
    /// Position of the closest one around it in the list, or -1.
    int parent = -1;
    /// Corners of its bounding box.
    Vector3 low = Vector3::Zero();
    Vector3 high = Vector3::Zero();
};

/// All closed components with what lies in what, in the order of their smallest triangle.
/// `make_solid` takes those with one outer shell and nothing deeper than cavities.
///
/// @throws TopologyError, GeometryError  as `make_solid` for a component that is no shell, and for
///                                       shells that cross
[[nodiscard]] std::vector<NestedShell> nest_shells(const TriangleSoup& soup);

/// How often closed triangles wind around a point: 1 inside a surface that is oriented outwards, 0
/// outside, in between on the surface itself (one half inside a flat face).
///
/// Source: [VanOosteromStrackee83] for the solid angle of a triangle
[[nodiscard]] double winding_number(const TriangleSoup& soup, const Vector3& point);

}  // namespace couture::meshing
