#pragma once

#include <optional>
#include <vector>

#include "meshing/surface/quad_grid.h"
#include "meshing/surface/strain_region.h"
#include "meshing/surface/surface_mesh.h"

namespace couture::meshing {

struct InflationOptions {
    /// Quads along each edge of the cube whose image the sphere is: 6 n^2 in all.
    int n_divisions = 16;
    /// Of the sphere at the start; nothing: find_cavity_center.
    std::optional<Vector3> center = std::nullopt;
    /// Nothing: nine tenths of the centre's distance from the wall.
    std::optional<double> radius = std::nullopt;
    /// Largest (l - l0) / l0 of an edge, l0 being its length at the start.
    double strain_limit = 3.0;
    /// Of edges with an end that would meet no wall on its way, instead of `strain_limit`.
    std::optional<double> outlet_strain_limit = std::nullopt;
    /// Other limits where the middle of an edge is; the first that fits counts, before all others.
    std::vector<StrainRegion> regions = {};
    /// A ball of this diameter around a vertex touches the rim of holes that it does not fit
    /// through, so that they count as wall; nothing: the length that nine tenths of the wall's
    /// edges do not exceed, so that most missing triangles are no holes, and 2 % of the diagonal of
    /// its box at most.
    std::optional<double> hole_size = std::nullopt;
};

/// Why a vertex stopped.
enum class InflationStop { contact, strain };

struct InflatedSphere {
    /// Numbers are those of make_cube_sphere.
    QuadMesh mesh;
    Vector3 center = Vector3::Zero();
    /// At the start.
    double radius = 0.0;
    /// Of the vertices.
    std::vector<InflationStop> stops;
    std::vector<std::array<int, 2>> edges;
    /// (l - l0) / l0 of the edges.
    std::vector<double> strains;
    /// Vertices that meet no wall on their way.
    int n_free = 0;

    [[nodiscard]] int n_contacts() const;
    [[nodiscard]] double max_strain() const;
};

/// A sphere inflated in a cavity until it meets the wall or its edges are strained to their limit:
/// quad meshes with the same connectivity in cavities of any topology. The wall may have openings
/// and any defects: triangles that occur twice, run either way, cross or share edges by threes.
///
/// The radius R of the sphere grows; a vertex moves away from the centre with it until it meets the
/// wall first or an edge at it has reached its limit: then both its ends stop for good. R goes from
/// one such event to the next, whose places are known in closed form: no step is too long, no
/// vertex goes through the wall, and there are at most as many events as vertices. A vertex that is
/// held at the rim of a small hole or opening stops half a hole's size before it.
///
/// @throws InputError     for no triangles, vertex numbers that do not exist, options out of range
/// @throws GeometryError  if no centre is found or the sphere does not fit at the start; if no
///                        vertex meets the wall
///
/// Source: [Maquart19] Sec. 5.2.3.3, Eq. (5.1). Differs: the inequality printed there holds at the
/// start; an edge stops where its total strain exceeds the limit.
[[nodiscard]] InflatedSphere inflate_sphere(const TriangleSoup& wall,
                                            const InflationOptions& options = {});

}  // namespace couture::meshing
