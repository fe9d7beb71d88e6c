#pragma once

#include <array>
#include <compare>
#include <functional>
#include <optional>
#include <string_view>
#include <vector>

#include "meshing/surface/surface_curves.h"
#include "meshing/surface/surface_mesh.h"
#include "meshing/topology/pants_criteria.h"

namespace couture::meshing {

enum class PantsCurveKind {
    /// Boundary loop of the surface.
    boundary,
    handle,
    /// Cycle around two boundary loops of what was left of the surface.
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
    /// The two loops that a cycle runs around.
    std::optional<std::array<CurveSide, 2>> around;
};

/// A piece of genus 0 with three boundary loops; or, if the surface has no pants, a sphere, disc,
/// cylinder or torus.
struct PantsPatch {
    /// Sides of curves that bound it; a handle may do so with both.
    std::vector<CurveSide> boundary;
    int genus = 0;

    [[nodiscard]] int euler_characteristic() const {
        return 2 - 2 * genus - static_cast<int>(boundary.size());
    }
};

struct PantsOptions {
    /// In which metric cycles are shortest (Alg. 3.2).
    CriterionWeights cycle = {};
    /// Which of the cycles is cut along first (Alg. 3.1).
    CriterionWeights merge = {};
    /// Called with what is being done and how far it is, in [0, 1]; may throw to stop.
    std::function<void(std::string_view, double)> progress = {};
};

struct PantsDecomposition {
    /// Boundary loops of the surface first, then handles, then cycles in the order of their making.
    /// The boundary has no numbers on its edges.
    std::vector<PantsCurve> curves;
    std::vector<PantsPatch> patches;
    /// For each face of the mesh.
    std::vector<int> patch_of_face;
    /// Tunnel loops as points; they are no cuts.
    std::vector<std::vector<Vector3>> tunnels;
    int genus = 0;
};

/// Cuts a surface into pants: along handle loops to genus 0, then again and again along the best
/// cycle around two boundary loops. Curves are edge paths of the mesh, which is refined where they
/// need room, and disjoint; their numbers stand on its edges.
///
/// Number of pants = -chi, number of curves inside = 3 genus + boundaries - 3, both checked. A
/// sphere, disc, cylinder or torus is one patch.
///
/// Cycles that score equal to 1e-9 are taken in the order of the curves they run around. After a
/// cut only cycles that passed what was cut off are looked for again.
///
/// @throws TopologyError  if the surface has several components or is no solid's boundary (see
///                        find_handle_tunnel_loops), or has curves already
/// @throws InputError     for weights that are negative or all 0
///
/// Source: [Maquart19] Alg. 3.1, 3.2, Sec. 2.1.2.5.
[[nodiscard]] PantsDecomposition decompose_into_pants(SurfaceMesh& mesh,
                                                      const PantsOptions& options = {});

}  // namespace couture::meshing
