#pragma once

#include <map>
#include <utility>
#include <vector>

#include "meshing/surface/cut_surface.h"
#include "meshing/topology/invariants.h"
#include "meshing/topology/pants.h"

namespace couture::meshing {

/// The curves that a surface is cut along so far, marked on its mesh, and their sides.
class PantsCurves {
  public:
    /// Sides of curves, ascending, each with the number of the boundary loop that it is.
    using Sides = std::vector<std::pair<CurveSide, int>>;

    /// @param mesh  must outlive the curves
    explicit PantsCurves(SurfaceMesh& mesh) : mesh_(mesh) {}

    /// Marks a curve that is no boundary and measures it.
    /// @return its number
    int add(PantsCurve curve);
    void set_kind(int number, PantsCurveKind kind) { curves_[number].kind = kind; }
    /// Puts the vertices into a curve by which its edges were split on a copy of the surface.
    ///
    /// @param vertices  of the curve on the copy before the splits
    /// @param handles   of the copy's vertices
    void refine(int number, const std::vector<int>& vertices, const CutSurface& copy,
                const std::vector<VertexHandle>& handles);

    [[nodiscard]] int size() const { return static_cast<int>(curves_.size()); }
    [[nodiscard]] const PantsCurve& operator[](int number) const { return curves_[number]; }
    [[nodiscard]] const std::vector<PantsCurve>& all() const { return curves_; }

    /// The side of a curve that a boundary loop of a piece is.
    [[nodiscard]] CurveSide side_of(const CutSurface& piece, const std::vector<int>& loop) const;
    [[nodiscard]] Sides sides_of(const CutSurface& piece,
                                 const std::vector<std::vector<int>>& loops) const;

  private:
    void note_sides(int number);

    SurfaceMesh& mesh_;
    std::vector<PantsCurve> curves_;
    /// By the halfedges along them.
    std::map<int, CurveSide> side_of_;
};

/// Whether a shell has pants: a sphere, disc, cylinder or torus has none.
[[nodiscard]] inline bool is_cut_into_pants(const SurfaceInvariants& shell) {
    return shell.euler_characteristic < 0;
}

/// The faces of each region between curves, see regions_between_curves.
[[nodiscard]] std::vector<std::vector<FaceHandle>> faces_between_curves(const SurfaceMesh& mesh);

/// The regions between curves as patches.
///
/// @param shells       of the uncut surface, see face_components
/// @param may_be_wide  patches may have more than three boundary loops
/// @throws TopologyError  if a patch of a shell with pants is none, or their number is not that of
///                        count_pants
[[nodiscard]] std::vector<PantsPatch> patches_between_curves(
    const SurfaceMesh& mesh, const PantsCurves& curves,
    const std::vector<SurfaceInvariants>& shells, bool may_be_wide);

}  // namespace couture::meshing
