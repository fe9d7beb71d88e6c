#include "meshing/volume/layout_of_volume.h"

#include <algorithm>
#include <set>

#include "iga/core/error.h"
#include "iga/topology/dof_map.h"

namespace couture::meshing {

namespace {

VolumetricLayout join_corners(const iga::MultiPatch<3>& volume) {
    const iga::KnotVector linear = iga::KnotVector::uniform(1, 1);
    const std::vector<iga::TensorSpace<3>> spaces(volume.patches.size(),
                                                  {{linear, linear, linear}});
    const iga::DofMap corners = iga::make_dof_map<3>(volume, spaces);
    VolumetricLayout layout;
    layout.n_nodes = corners.n_dofs;
    for (const std::vector<int>& numbers : corners.global) {
        std::ranges::copy(numbers, layout.cuboids.emplace_back().begin());
    }
    return layout;
}

}  // namespace

int corner_at(const std::array<iga::End, 3>& position) {
    int corner = 0;
    for (int k = 0; k < 3; ++k) corner |= position[k] == iga::End::high ? 1 << k : 0;
    return corner;
}

VolumetricLayout layout_of_volume(const iga::MultiPatch<3>& volume) {
    VolumetricLayout layout = join_corners(volume);
    for (int p = 0; p < layout.n_cuboids(); ++p) {
        const auto& nodes = layout.cuboids[p];
        const auto n_different = std::set<int>(nodes.begin(), nodes.end()).size();
        if (n_different != nodes.size()) {
            throw TopologyError(
                "layout: patch {} has {} different corners; a cuboid has 8: sides that collapse or "
                "meet their own patch are not possible",
                p, n_different);
        }
    }
    const std::vector<iga::PatchEntity<3>> outer = volume.outer_sides();
    for (const auto& [name, entities] : volume.boundary_sets) {
        for (const iga::PatchEntity<3>& entity : entities) {
            if (std::ranges::find(outer, entity) == outer.end()) continue;
            layout.sets[name].push_back({entity.patch, entity.side()});
        }
    }
    return layout;
}

}  // namespace couture::meshing
