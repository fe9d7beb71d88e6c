#pragma once

#include <array>
#include <string>
#include <vector>

#include "iga/core/types.h"
#include "meshing/surface/surface_mesh.h"

namespace couture::meshing {

/// What remains of a connected surface, or of a whole mesh, when it is bent and stretched.
struct SurfaceInvariants {
    /// Vertices without triangles don't count.
    int n_vertices = 0;
    int n_edges = 0;
    int n_faces = 0;
    int n_components = 0;
    /// Number of boundary loops.
    int n_boundaries = 0;
    /// Of several components: the sum of theirs.
    int genus = 0;
    /// n_vertices - n_edges + n_faces.
    int euler_characteristic = 0;
    /// Components, independent loops, closed components (cavities that the surface encloses).
    std::array<int, 3> betti{0, 0, 0};
};

/// Invariants of a mesh; several components are added up, so that
/// chi = 2 n_components - 2 genus - n_boundaries = b0 - b1 + b2.
///
/// @throws TopologyError  if the faces around a vertex form more than one fan, or if
///                        2 n_components - n_boundaries - chi is odd or negative: what is no
///                        surface; with the vertex or the numbers
///
/// Source: [Maquart19] Eq. (2.2)-(2.4)
[[nodiscard]] SurfaceInvariants compute_invariants(const SurfaceMesh& mesh);

/// Invariants of each connected component, in the order of their smallest face.
///
/// @throws TopologyError  as `compute_invariants`
[[nodiscard]] std::vector<SurfaceInvariants> component_invariants(const SurfaceMesh& mesh);

/// For each face the number of its component; components in the order of their smallest face.
[[nodiscard]] std::vector<int> face_components(const SurfaceMesh& mesh);

/// Name of the connected surfaces of a genus with a number of boundaries: "sphere", "disc",
/// "cylinder", "torus", "pant", "4-pant" (a sphere with four or more holes), else as
/// "genus 2 with 1 boundary".
///
/// @throws InputError  if a number is negative
[[nodiscard]] std::string surface_name(int genus, int n_boundaries);
/// The same of a mesh; of several components "3 components: sphere, torus, disc".
[[nodiscard]] std::string surface_name(const SurfaceMesh& mesh);

/// A pants decomposition in numbers.
struct PantsCount {
    /// -chi.
    int n_pants = 0;
    /// Curves along which the surface is cut.
    int n_curves = 0;
};

/// 2 g + b - 2 pants and 3 g + b - 3 curves.
///
/// @throws TopologyError  if the Euler characteristic is above -1: sphere, disc, cylinder and torus
///                        have no pants
///
/// Source: [Maquart19] Eq. (2.6)
[[nodiscard]] PantsCount count_pants(int genus, int n_boundaries);

/// A boundary loop of a surface.
struct BoundaryLoop {
    /// In order with the surface on the left, smallest number first.
    std::vector<VertexHandle> vertices;
    double length = 0.0;
    /// Centre of mass of the loop's edges.
    Vector3 center = Vector3::Zero();
};

/// Boundary loops in the order of their smallest vertex.
[[nodiscard]] std::vector<BoundaryLoop> boundary_loops(const SurfaceMesh& mesh);

/// Sum of Gaussian and geodesic curvature minus 2 pi chi, in radians.
///
/// Source: [Maquart19] Eq. (2.9)
[[nodiscard]] double gauss_bonnet_defect(const SurfaceMesh& mesh);

/// Gauss-Bonnet theorem: |defect| <= 1e-9 max(1, n_vertices / 1000). It holds on any triangulated
/// surface up to rounding, unless a triangle has two corners in one place.
///
/// @throws TopologyError  with the defect and the first triangle whose angles don't sum to pi
///
/// Source: [Maquart19] Eq. (2.9)
void check_gauss_bonnet(const SurfaceMesh& mesh);

/// How the triangles of a soup run along their common edges.
enum class Orientation {
    /// In opposite directions: as they should.
    consistent,
    /// Could be made so by turning triangles round.
    inconsistent,
    /// Cannot: a Moebius strip, a Klein bottle, or an edge with more than two triangles.
    impossible,
};

[[nodiscard]] Orientation orientation_of(const TriangleSoup& soup);

}  // namespace couture::meshing
