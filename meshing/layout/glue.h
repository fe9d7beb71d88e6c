#pragma once

#include <vector>

#include "meshing/layout/cuboid_template.h"

namespace couture::meshing {

/// A cap of the template of a patch.
struct PatchCap {
    int patch = 0;
    int cap = 0;
    auto operator<=>(const PatchCap&) const = default;
};

/// Two caps that become one inner face, as match_caps lays them on each other.
struct CapJoint {
    PatchCap first;
    PatchCap second;
    int rotation = 0;
};

struct GluedLayout {
    /// Caps that were not joined are sets with names "PATCH.CAP", as "2.x_low".
    VolumetricLayout layout;
    /// For each patch and node of its template the node here. The first patch keeps its numbers.
    std::vector<std::vector<int>> nodes;
    /// Cuboid c of patch p is first_cuboid[p] + c here.
    std::vector<int> first_cuboid;
};

/// One layout of the templates of all patches.
///
/// @throws InputError     for a patch or cap that does not exist or is joined twice
/// @throws TopologyError  if patterns don't match at a joint's rotation (lists those at which they
///                        would), or two nodes would have two arcs between them; names the joint
///
/// Source: [Maquart19] Fig. 6.3, backwards: boundaries between patches open again
[[nodiscard]] GluedLayout glue_templates(const std::vector<CuboidTemplate>& patches,
                                         const std::vector<CapJoint>& joints);

}  // namespace couture::meshing
