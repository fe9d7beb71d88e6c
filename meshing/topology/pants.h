#pragma once

#include <array>
#include <compare>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "meshing/surface/surface_curves.h"
#include "meshing/surface/surface_mesh.h"
#include "meshing/topology/pants_criteria.h"
#include "meshing/topology/traced_loop.h"

namespace couture::meshing {

enum class PantsCurveKind {
    /// Boundary loop of the surface.
    boundary,
    /// Takes a handle off: does not divide what was left of the surface.
    handle,
    /// Divides what was left of the surface, once all handles are cut.
    cycle,
};

[[nodiscard]] std::string_view to_string(PantsCurveKind kind);

/// One of the two sides of a curve.
struct CurveSide {
    int curve = -1;
    bool is_left = true;

    friend bool operator==(const CurveSide&, const CurveSide&) = default;
    friend auto operator<=>(const CurveSide&, const CurveSide&) = default;
};

struct PantsCurve {
    PantsCurveKind kind = PantsCurveKind::cycle;
    SurfaceCurve curve;
    double length = 0.0;
    /// Of boundary loops: see PantsOptions::boundary_names.
    std::string name = {};
    /// The two loops that a cycle runs around; none of handles and of loops that were given.
    std::optional<std::array<CurveSide, 2>> around = {};
};

/// A piece of genus 0 with three boundary loops, or with up to six; or, if the surface has no
/// pants, a sphere, disc, cylinder or torus (cut open on demand).
struct PantsPatch {
    /// Sides of curves that bound it; a handle may do so with both.
    std::vector<CurveSide> boundary;
    int genus = 0;
    /// Connected component of the surface, see face_components.
    int shell = 0;

    [[nodiscard]] int euler_characteristic() const {
        return 2 - 2 * genus - static_cast<int>(boundary.size());
    }
};

struct PantsOptions {
    /// In which metric cycles are shortest (Alg. 3.2).
    CriterionWeights cycle = {};
    /// Which of the cycles is cut along first (Alg. 3.1).
    CriterionWeights merge = {};
    /// Closed curves that are cut along first, in this order.
    std::vector<GuideLoop> loops = {};
    /// Distance from such a curve at which a detour costs double, by the diagonal of the surface's
    /// box.
    double loop_width = 0.02;
    /// Cuts a torus without boundary along its handle too: what is left is a cylinder that meets
    /// itself.
    bool cuts_tori = false;
    /// Ends with the handles: there are no cycles and no patches.
    bool only_handles = false;
    /// No cuts are added to the loops; what lies between them must have genus 0 and may have any
    /// number of boundary loops.
    bool only_given_loops = false;
    /// Of the boundary loops, in the order of boundary_loops; empty: they have none.
    std::vector<std::string> boundary_names = {};
    /// Order of the boundary loops (see boundary_loops) among the curves; empty: as they are.
    std::vector<int> boundary_order = {};
    /// Points on the surface; for each list a cycle is made that passes them, around the two loops
    /// for which it is shortest (Alg. 3.3). It follows sharp edges that pass two of them.
    std::vector<std::vector<Vector3>> cycles_through = {};
    /// Pants are put together again to patches of up to so many boundary loops (3 to 6), where the
    /// tube between them is short: see merge_ratio.
    int most_boundaries = 3;
    /// A cut is removed if the tube that it divides is shorter than so many of its diameters.
    double merge_ratio = 1.0;
    /// Called with what is being done and how far it is, in [0, 1]; may throw to stop.
    std::function<void(std::string_view, double)> progress = {};
};

struct PantsDecomposition {
    /// Boundary loops of the surface first, then loops that were given, handles, cycles in the
    /// order of their making.
    /// The boundary has no numbers on its edges.
    std::vector<PantsCurve> curves;
    std::vector<PantsPatch> patches;
    /// For each face of the mesh.
    std::vector<int> patch_of_face;
    /// Tunnel loops as points; they are no cuts.
    std::vector<std::vector<Vector3>> tunnels;
    /// Of several shells: the sum of theirs.
    int genus = 0;
};

/// Cuts a surface into pants: along handle loops to genus 0, then again and again along the best
/// cycle around two boundary loops. Curves are edge paths of the mesh, which is refined where they
/// need room, and disjoint; their numbers stand on its edges.
///
/// Number of pants = -chi, number of curves inside = 3 genus + boundaries - 3, both checked before
/// pants are put together to larger patches (n-pants: pants, shirt, suit, spacesuit). A sphere,
/// disc, cylinder or torus is one patch, see PantsOptions::cuts_tori.
///
/// The shells of a solid with cavities are cut one by one. Handles bound in the material: around a
/// cavity they are the loops that bound outside of it, and tunnels bound in it.
///
/// Cycles that score equal to 1e-9 are taken in the order of the curves they run around. After a
/// cut only cycles that passed what was cut off are looked for again.
///
/// @param mesh  oriented out of the material: the walls of cavities into these
/// @throws TopologyError  if a shell of the surface is no solid's boundary (see
///                        find_handle_tunnel_loops), or if it has curves already
/// @throws InputError     for weights that are negative or all 0, other options out of their range,
///                        and for loops and points that are not on the surface (see trace_loop)
/// @throws TopologyError  for given loops that bound outside the solid, bound a disc or are
///                        parallel to another cut, and for points through which no cycle passes
///
/// Source: [Maquart19] Alg. 3.1, 3.2, 3.3, Sec. 2.1.2.5.
[[nodiscard]] PantsDecomposition decompose_into_pants(SurfaceMesh& mesh,
                                                      const PantsOptions& options = {});

/// Whether the loops and points of the options can be followed on the mesh, which is marked with
/// the loops. Nothing else is cut.
///
/// @throws  as decompose_into_pants for its options, and for loops and points
void check_given_curves(SurfaceMesh& mesh, const PantsOptions& options);

}  // namespace couture::meshing
