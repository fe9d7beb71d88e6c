#include "io/yeti_sets.h"

#include <algorithm>

namespace couture::io {

template <int d>
std::set<int> nodes_of(const iga::MultiPatch<d>& multipatch, const NodeNumbers& nodes,
                       const iga::BoundarySet<d>& entities) {
    std::set<int> result;
    for (const iga::PatchEntity<d>& entity : entities) {
        for (const int function :
             iga::functions_on<d>(multipatch.patches[entity.patch].space(), entity.position)) {
            result.insert(nodes[entity.patch][function]);
        }
    }
    return result;
}

namespace {

/// Nodes of sides that two patches share.
template <int d>
std::set<std::set<int>> shared_sides(const iga::MultiPatch<d>& multipatch,
                                     const NodeNumbers& nodes) {
    std::set<std::set<int>> once;
    std::set<std::set<int>> twice;
    for (int patch = 0; patch < multipatch.n_patches(); ++patch) {
        for (const iga::PatchEntity<d>& side : iga::entities_of_patch<d>(patch, d - 1)) {
            const std::set<int> here = nodes_of<d>(multipatch, nodes, {side});
            if (!once.insert(here).second) {
                twice.insert(here);
            }
        }
    }
    return twice;
}

}  // namespace

template <int d>
std::optional<iga::BoundarySet<d>> entities_of(const iga::MultiPatch<d>& multipatch,
                                               const NodeNumbers& nodes,
                                               const std::set<int>& node_set) {
    const auto is_in_set = [&](int node) { return node_set.count(node) > 0; };
    for (const std::vector<int>& of_patch : nodes) {
        if (std::all_of(of_patch.begin(), of_patch.end(), is_in_set)) {
            return std::nullopt;
        }
    }
    const std::set<std::set<int>> shared = shared_sides(multipatch, nodes);
    iga::BoundarySet<d> result;
    std::set<int> covered;
    for (int dimension = d - 1; dimension >= 0; --dimension) {
        for (int patch = 0; patch < multipatch.n_patches(); ++patch) {
            for (const iga::PatchEntity<d>& entity : iga::entities_of_patch<d>(patch, dimension)) {
                const std::set<int> here = nodes_of<d>(multipatch, nodes, {entity});
                const bool is_new = dimension == d - 1
                                        ? shared.count(here) == 0
                                        : std::any_of(here.begin(), here.end(), [&](int node) {
                                              return covered.count(node) == 0;
                                          });
                if (is_new && std::all_of(here.begin(), here.end(), is_in_set)) {
                    result.push_back(entity);
                    covered.insert(here.begin(), here.end());
                }
            }
        }
    }
    if (covered.size() != node_set.size()) {
        return std::nullopt;
    }
    return result;
}

#define COUTURE_INSTANTIATE(d)                                                     \
    template std::set<int> nodes_of(const iga::MultiPatch<d>&, const NodeNumbers&, \
                                    const iga::BoundarySet<d>&);                   \
    template std::optional<iga::BoundarySet<d>> entities_of(                       \
        const iga::MultiPatch<d>&, const NodeNumbers&, const std::set<int>&);
COUTURE_INSTANTIATE(2)
COUTURE_INSTANTIATE(3)
#undef COUTURE_INSTANTIATE

}  // namespace couture::io
