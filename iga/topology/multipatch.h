#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "iga/spline/patch.h"
#include "iga/topology/patch_sides.h"

namespace couture::iga {

template <int d>
using BoundarySet = std::vector<PatchEntity<d>>;

/// Patches, how they meet, and named parts of the boundary: the one object passed between
/// meshing, solver, reduced-order model and files. Interfaces conform (equal degree and knots up
/// to an affine change and orientation).
template <int d>
struct MultiPatch {
    std::vector<Patch<d>> patches;
    std::vector<Interface<d>> interfaces;
    std::map<std::string, BoundarySet<d>> boundary_sets;

    [[nodiscard]] int n_patches() const { return static_cast<int>(patches.size()); }
    /// Number of coordinates, the same for all patches.
    [[nodiscard]] int dimension() const { return patches.empty() ? d : patches[0].dimension(); }
    /// Number of control points, shared ones counted in each patch.
    [[nodiscard]] int n_control_points() const;
    /// Lower and upper corner of the box around all control points: dimension x 2.
    [[nodiscard]] MatrixX bounding_box() const;
    /// Length of that box's diagonal: what tolerances are relative to.
    [[nodiscard]] double size() const;
    /// Sides that belong to no interface, in order of patch and side.
    [[nodiscard]] std::vector<PatchEntity<d>> outer_sides() const;
    /// @throws TopologyError  if there is no such set: names the nearest and lists all
    [[nodiscard]] const BoundarySet<d>& boundary_set(const std::string& name) const;
};

/// The part of `check` that looks at no control points: existing patches and sides, none in two
/// interfaces, conforming degrees and knots, existing entities in boundary sets.
///
/// @throws TopologyError  naming the first offending patch, side or set
template <int d>
void check_combinatorics(const MultiPatch<d>& multipatch);

/// Checks counts, that every interface names existing sides and none twice, that interfaces
/// conform in degree, knots, and (within `tolerance` of the size) in control points and weights up
/// to a factor, and that boundary sets name existing entities.
///
/// @throws TopologyError, GeometryError  naming the first offending patch, side and gap
template <int d>
void check(const MultiPatch<d>& multipatch, double tolerance = 1e-6);

/// Hash of the combinatorics: degrees, knots, interfaces with orientation, boundary sets, counts of
/// control points (not their positions). 16 hexadecimal digits. Equal signatures are what
/// isotopological means.
template <int d>
[[nodiscard]] std::string signature(const MultiPatch<d>& multipatch);

/// Volume (area for d = 2): integral of |det J| with degree-exact Gauss rules for B-splines
/// (rational patches: as many points as the spread of the weights asks for; 1e-13 on quarter
/// circles). Surfaces in space: their area.
template <int d>
[[nodiscard]] double volume(const MultiPatch<d>& multipatch);

/// Refines every patch alike (k-refinement; see refine(KnotVector, degree, n_elements)).
/// `degree` nothing: keep; `elements` per direction, at least; nothing: keep.
///
/// @throws InputError  if a degree is below the geometry's or the result does not conform
template <int d>
[[nodiscard]] MultiPatch<d> refine(const MultiPatch<d>& multipatch, std::optional<int> degree,
                                   std::optional<std::array<int, d>> n_elements);

}  // namespace couture::iga
