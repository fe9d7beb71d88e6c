#pragma once

#include "iga/topology/multipatch.h"

namespace couture::iga {

/// Global numbers of the patches' functions.
struct DofMap {
    int n_dofs = 0;
    /// [patch][local function] -> global number. Numbered patch by patch in local order, a shared
    /// function at its first occurrence.
    std::vector<std::vector<int>> global;
};

/// Joins functions across interfaces, and functions along collapsed lines of sides and edges (those
/// on which the geometry is one point).
///
/// @param spaces  field space of every patch; conforming across every interface
/// @param tolerance  relative to the size: shorter lines count as collapsed
/// @throws TopologyError  naming the interface whose spaces do not conform
template <int d>
[[nodiscard]] DofMap make_dof_map(const MultiPatch<d>& geometry,
                                  const std::vector<TensorSpace<d>>& spaces,
                                  double tolerance = 1e-9);

/// A side or edge on which the geometry has a lower dimension.
template <int d>
struct CollapsedEntity {
    PatchEntity<d> entity;
    /// Free directions in which every line of control points is one point.
    std::vector<int> directions;
    /// "patch 0 side 0:low collapses in direction 1".
    [[nodiscard]] std::string name() const;
};

/// Sides and edges of the patches that collapse, for messages: sides first; an edge only if it is
/// not part of a side that collapses in the same direction.
template <int d>
[[nodiscard]] std::vector<CollapsedEntity<d>> collapsed_entities(const MultiPatch<d>& geometry,
                                                                 double tolerance = 1e-9);

}  // namespace couture::iga
