#pragma once

#include <vector>

#include "meshing/surface/surface_mesh.h"

namespace couture::meshing {

/// A solid around closed curves, and those curves.
struct KnottedSolid {
    /// Closed, oriented outwards.
    TriangleSoup surface;
    /// Closed polygons deep inside, one for each hole; together they are a basis of the solid's
    /// first homology.
    std::vector<std::vector<Vector3>> cores;
};

/// n points of the torus knot T(p, q): p times around the z axis at radius 2 to 4, while |q| times
/// around the torus' tube of radius 1.
[[nodiscard]] std::vector<Vector3> make_torus_knot(int p, int q, int n);

/// n points of a figure-eight knot.
[[nodiscard]] std::vector<Vector3> make_figure_eight_knot(int n);

/// Tube of n_around x (number of points) x 2 triangles around a closed polygon. Sections turn as
/// little as can be along the core, and evenly by what is left to close.
[[nodiscard]] KnottedSolid make_closed_tube(const std::vector<Vector3>& core, int n_around,
                                            double radius);

/// Genus 2: the tube around a trefoil T(2, 3) with an arch that leaves the tube and comes back to
/// it a little farther along.
[[nodiscard]] KnottedSolid make_trefoil_with_arch(int n_around, int n_along);

/// Linking number of two closed polygons that don't meet, by Gauss's integral; each pair of
/// segments adds a solid angle in closed form.
///
/// Source: [KleninLangowski00], method 1a.
[[nodiscard]] double gauss_linking_number(const std::vector<Vector3>& a,
                                          const std::vector<Vector3>& b);

}  // namespace couture::meshing
