#pragma once

#include "iga/topology/multipatch.h"

namespace couture::iga {

/// Finds all pairs of outer sides that coincide (control points, and weights up to a common
/// factor, within `tolerance` of the bounding box diagonal; any of the 8 orientations, reversed
/// knots included) and appends them to the interfaces. Sides that have the same shape but other
/// knots or degrees are first refined to the common knot vector; the refinement runs on through
/// all patches that share that direction.
///
/// A side whose control points all coincide (collapsed to an arc or a point) is never an
/// interface.
///
/// Time grows linearly with the number of sides.
///
/// @return sides that overlap in their four corners but whose shapes differ, as warnings with
///         both sides and the largest gap. Sides that bulge away from each other by more than half
///         their extent (the two halves of a hole's rim) are meant to differ and not reported.
/// @throws TopologyError  if three sides coincide
template <int d>
std::vector<std::string> find_interfaces(MultiPatch<d>& multipatch, double tolerance = 1e-6);

/// Refines where given interfaces do not conform in knots or degree until all do: all patches
/// that share a direction across interfaces get the common knot vector there.
///
/// @param tolerance  relative to the size; infinity: shapes are not compared
/// @throws TopologyError  if the shapes differ by more than `tolerance` of the size: names both
///                        sides and the largest gap
template <int d>
void make_conforming(MultiPatch<d>& multipatch, double tolerance = 1e-6);

/// The same for functions alone: false if nothing had to be done.
template <int d>
bool make_conforming(std::vector<TensorSpace<d>>& spaces,
                     const std::vector<Interface<d>>& interfaces);

}  // namespace couture::iga
