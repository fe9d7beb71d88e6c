#pragma once

#include <optional>
#include <set>
#include <vector>

#include "iga/topology/multipatch.h"

namespace couture::io {

/// [patch][function] -> node.
using NodeNumbers = std::vector<std::vector<int>>;

/// Nodes of the entities.
template <int d>
[[nodiscard]] std::set<int> nodes_of(const iga::MultiPatch<d>& multipatch, const NodeNumbers& nodes,
                                     const iga::BoundarySet<d>& entities);

/// The outer sides all of whose nodes are in the set, then the edges and corners that hold nodes
/// not covered yet; nothing if nodes are left over or a patch lies in the set as a whole.
template <int d>
[[nodiscard]] std::optional<iga::BoundarySet<d>> entities_of(const iga::MultiPatch<d>& multipatch,
                                                             const NodeNumbers& nodes,
                                                             const std::set<int>& node_set);

}  // namespace couture::io
