#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "iga/core/types.h"
#include "meshing/surface/surface_mesh.h"

namespace couture::meshing {

/// Discrete Gaussian curvature of each vertex, in radians: K_v = 2 pi - sum of the angles around an
/// inner vertex, 0 at boundary vertices (theirs is `geodesic_curvature`) and at vertices without
/// triangles.
///
/// Source: [Maquart19] Eq. (2.18)
[[nodiscard]] std::vector<double> gaussian_curvature(const SurfaceMesh& mesh);

/// Discrete geodesic curvature of each vertex, in radians: k_v = pi - sum of the angles of the
/// surface at a boundary vertex (positive where the surface is convex there), 0 at inner vertices.
/// Together the two sum to 2 pi times the Euler characteristic.
///
/// Source: [Maquart19] Eq. (2.19). Differs: there the straightness of a curve is normalised by the
/// total angle, which does not satisfy Eq. (2.9).
[[nodiscard]] std::vector<double> geodesic_curvature(const SurfaceMesh& mesh);

/// Curvature of a surface at a point, in 1 / length; positive where the surface bends away from its
/// normal (a sphere oriented outwards: 1 / radius twice).
struct PrincipalCurvatures {
    /// The smaller and the larger one.
    double minimum = 0.0;
    double maximum = 0.0;
    /// Unit tangents along which the surface bends so; with `normal` a right-handed frame. Where
    /// both are equal, any such frame.
    Vector3 minimum_direction = Vector3::Zero();
    Vector3 maximum_direction = Vector3::Zero();
    /// Mean normal of the surface in the disc, unit length.
    Vector3 normal = Vector3::Zero();

    [[nodiscard]] double mean() const { return 0.5 * (minimum + maximum); }
    [[nodiscard]] double gaussian() const { return minimum * maximum; }
};

struct CurvatureOptions {
    /// Radius of the disc around each vertex, a length; without it `edges_per_radius` times the
    /// mean length of the edges at the vertex.
    std::optional<double> radius = {};
    double edges_per_radius = 3.0;
    /// Whether edges tagged as features (detect_features) bend like all others; else the disc of a
    /// vertex ends at them.
    bool crosses_features = false;
};

/// Principal curvatures of each vertex: those of the curvature tensor averaged over a disc B,
///
///     T = 1 / area(B) sum over edges e of beta(e) length(e in B) e e^T,
///
/// with beta the signed angle between the normals of the two faces, positive on convex edges. B is
/// the part of the surface inside a ball around the vertex that hangs together with it. If
/// features are not crossed, a vertex on one has the curvatures of the smooth side that has most of
/// the disc. Zero at vertices without triangles.
///
/// Converges to the smooth curvatures when radius and edge length / radius both go to zero.
/// Cost: proportional to the number of triangles in all discs.
///
/// @throws InputError  if a radius is not positive
///
/// Source: [CohenSteinerMorvan03]
[[nodiscard]] std::vector<PrincipalCurvatures> principal_curvatures(
    const SurfaceMesh& mesh, const CurvatureOptions& options = {});

/// Kinds of vertices by their Gaussian curvature.
///
/// Source: [Maquart19] Eq. (2.20)
enum class CurvatureClass {
    sharp,
    spherical,
    euclidean,
    hyperbolic,
    ultrahyperbolic,
    solid_angle,
};

/// "sharp", "spherical" ...
[[nodiscard]] std::string_view to_string(CurvatureClass curvature_class);

/// The class whose curvature is nearest: 2 pi, pi/2, 0, -pi/2, -pi, -2 pi in the order of
/// CurvatureClass; halfway between two the one nearer to zero.
///
/// @param curvature  of a vertex or, summed, of a cluster; radians
[[nodiscard]] CurvatureClass classify_curvature(double curvature);

/// Index in quarter turns of the cross field's singularity that belongs at a vertex of a class;
/// nothing for sharp and solid_angle, where none is defined.
///
/// Source: [Maquart19] Eq. (2.27)
[[nodiscard]] std::optional<int> expected_index(CurvatureClass curvature_class);

}  // namespace couture::meshing
