#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "meshing/surface/surface_mesh.h"
#include "meshing/topology/shells.h"

namespace couture::meshing {

/// What keeps triangles from being the boundary of one solid. The numbers are those of the array
/// "problem" in files.
enum class FlawKind {
    none = 0,
    /// A chain of edges with one triangle: the surface is open there.
    open_boundary = 1,
    /// An edge with three or more triangles.
    non_manifold_edge = 2,
    /// A vertex where several fans of triangles touch.
    non_manifold_vertex = 3,
    /// An edge along which two triangles run in the same direction. After `repair_surface` such
    /// are left only where the surface cannot be oriented.
    inconsistent_edge = 4,
    /// A closed shell whose normals point into the material.
    inside_out = 5,
    /// A shell beside the largest one, or a solid in a cavity of it; of open surfaces every
    /// component but the one with the most triangles.
    disjoint_shell = 6,
    /// A triangle without extent: its height is at most 1e-9 of its longest side.
    flat_triangle = 7,
    /// A triangle with the same three vertices as another one.
    duplicate_triangle = 8,
    /// Two triangles that cross, touch or lie on each other.
    self_intersection = 9,
    /// Fewer than four triangles bound nothing.
    too_few_triangles = 10,
    /// A shell that encloses no volume, or crosses another as its vertices show.
    no_volume = 11,
};
constexpr int n_flaw_kinds = 12;

/// "open boundary", "non-manifold edge", ...
[[nodiscard]] std::string to_string(FlawKind kind);

/// One place with a flaw.
struct SurfaceFlaw {
    FlawKind kind = FlawKind::none;
    /// The triangles there, ascending but for crossing pairs (smaller one first).
    std::vector<int> triangles;
    /// A loop's or shell's centre, an edge's middle, a vertex, a point of both triangles.
    Vector3 position = Vector3::Zero();
    /// What can be drawn of loops and edges: their points.
    std::vector<Vector3> line;
    bool is_closed = false;
    /// Of loops and edges.
    double length = 0.0;
    /// One line for people: "(0.5, 0, 1): edge of vertices 3 and 7 with 3 triangles: 0, 4, 9".
    std::string text;
};

struct CheckOptions {
    /// So many pairs of crossing triangles are listed.
    std::size_t max_crossings = 10000;
};

struct SurfaceCheck {
    /// By kind, then place.
    std::vector<SurfaceFlaw> flaws;
    /// Whether there may be more self-intersections than are listed.
    bool has_more_crossings = false;
    /// Where the surface is closed, oriented and without crossings: what lies in what.
    std::vector<NestedShell> shells;
    /// Where it bounds one solid, whether or not its shells are inside out.
    std::optional<Solid> solid;

    [[nodiscard]] int count(FlawKind kind) const;
    /// Of a kind, null if there is none.
    [[nodiscard]] const SurfaceFlaw* first(FlawKind kind) const;
    /// No flaw of any kind.
    [[nodiscard]] bool is_clean() const { return flaws.empty(); }
};

/// All that is wrong with triangles as the boundary of one solid, with places; nothing is changed.
/// Shells that lie in another one are its cavities, which is legal. O(n log n) but for shells:
/// each is compared with larger ones whose bounding boxes hold its own.
///
/// @param soup  points that are equal must have one number, as `repair_surface` leaves them
/// @throws InputError  for vertex numbers that do not exist
[[nodiscard]] SurfaceCheck check_solid(const TriangleSoup& soup, const CheckOptions& options = {});

/// Lines for people, one for each kind that was found with the first places below it, indented:
/// ```
/// 2 open boundaries:
///   (0, 0, 1): loop of 12 edges, length 3.10583
///   (0, 0, 0): loop of 12 edges, length 3.10583
/// ```
///
/// @param max_places  of each kind; "..." stands for the others
[[nodiscard]] std::vector<std::string> summarize(const SurfaceCheck& check, int max_places = 3);

/// For each triangle the number of the flaw that it belongs to, the first kind of several except
/// that whole shells come last; triangles at an open edge have that of the open boundary.
[[nodiscard]] std::vector<int> flaw_of_triangle(const SurfaceCheck& check, std::size_t n_triangles);

/// Turns the shells of a closed surface so that normals point out of the material: out of outer
/// shells, into cavities. Open components are left as they are, but where `repair_surface` had to
/// choose a side (`turned`) theirs becomes the one with positive volume, each boundary loop closed
/// by triangles to its centre.
///
/// @param turned  triangles that were turned before
/// @return how many shells were turned
int orient_outwards(TriangleSoup& soup, const std::vector<int>& turned = {});

/// One component of several, as a body of its own.
struct SelectedShell {
    TriangleSoup soup;
    /// Whether it was the wall of a cavity: the body is then what lies inside the cavity.
    bool was_cavity = false;
};

/// The component of a number (in the order of their smallest triangle, across common vertices); if
/// it is closed, with the closed shells directly in it, which are its cavities. Triangles turn as
/// they did.
///
/// @throws InputError  if there is no such component: how many there are
/// @throws TopologyError, GeometryError  if the shell encloses nothing, or touches one whose box
///                                       lies in its own, or the other way round
[[nodiscard]] SelectedShell select_shell(const TriangleSoup& soup, int number);

}  // namespace couture::meshing
