#pragma once

#include <functional>
#include <string>

#include "iga/topology/multipatch.h"

namespace couture::meshing {

/// Straight Bezier curve of the given degree with equally spaced control points.
[[nodiscard]] iga::Curve make_segment(const VectorX& from, const VectorX& to, int degree = 1);

/// Straight lines from `low` to `high`, which have the same space: the new direction comes first
/// (radius first, then the direction around), blended in homogeneous coordinates.
template <int d>
[[nodiscard]] iga::Patch<d + 1> blend(const iga::Patch<d>& low, const iga::Patch<d>& high);

/// The patch with `map` applied to its control points; exact for an affine `map`.
template <int d>
[[nodiscard]] iga::Patch<d> mapped(const iga::Patch<d>& patch,
                                   const std::function<VectorX(const VectorX&)>& map);

/// A plane surface moved along z from `z_low` to `z_high`: the new direction comes last.
[[nodiscard]] iga::Volume make_slab(const iga::Surface& surface, double z_low, double z_high);

/// Every patch of a plane multipatch as a slab; interfaces are not carried over.
[[nodiscard]] iga::MultiPatch<3> make_slabs(const iga::MultiPatch<2>& plane, double z_low,
                                            double z_high);

/// True on the wanted place; plane points have z = 0.
using Place = std::function<bool(const Vector3&)>;

/// Plane x_axis = value, within `tolerance`.
[[nodiscard]] Place on_plane(int axis, double value, double tolerance);
/// Points at distance `radius` from the line along `axis` through the origin.
[[nodiscard]] Place on_cylinder(int axis, double radius, double tolerance);

/// For `find_interfaces`: sides made from the same numbers differ by rounding only, and a part may
/// be thousands of times longer than thick.
constexpr double interface_tolerance = 1e-10;

/// Length below which two places are one: 1e-9 of the size.
template <int d>
[[nodiscard]] double place_tolerance(const iga::MultiPatch<d>& multipatch);

/// Names the outer sides that lie wholly on `place`.
template <int d>
void name_outer_sides(iga::MultiPatch<d>& multipatch, const std::string& name, const Place& place);

/// Names the entities of the given dimension (inner ones too) that lie wholly on `place`, each
/// place once although several patches share it.
template <int d>
void name_entities(iga::MultiPatch<d>& multipatch, const std::string& name, int dimension,
                   const Place& place);

}  // namespace couture::meshing
