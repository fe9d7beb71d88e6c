#include "meshing/topology/tree_cotree.h"

#include <algorithm>

#include "iga/core/disjoint_sets.h"

namespace couture::meshing {

TreeCotree make_tree_cotree(const CutSurface& surface, std::span<const int> sources) {
    TreeCotree result{.tree = ShortestPaths(surface), .cotree = {}, .generators = {}};
    ShortestPaths& tree = result.tree;
    tree.run({.sources = sources});
    std::vector<bool> is_in_tree(surface.n_halfedges(), false);
    for (const int v : tree.settled()) {
        const int h = tree.arrival(v);
        if (h < 0) continue;
        is_in_tree[h] = is_in_tree[surface.twin(h)] = true;
    }
    struct Rest {
        double loop_length;
        int halfedge;
    };
    std::vector<Rest> rest;
    for (int h = 0; h < surface.n_halfedges(); ++h) {
        if (h > surface.twin(h) || is_in_tree[h]) continue;
        rest.push_back({tree.distance(surface.origin(h)) + tree.distance(surface.target(h)) +
                            surface.length(h),
                        h});
    }
    std::sort(rest.begin(), rest.end(), [](const Rest& a, const Rest& b) {
        return a.loop_length != b.loop_length ? a.loop_length > b.loop_length
                                              : a.halfedge < b.halfedge;
    });
    DisjointSets sets(surface.n_faces());
    result.cotree.resize(surface.n_faces());
    for (const auto& [length, h] : rest) {
        const int left = CutSurface::face(h);
        const int right = CutSurface::face(surface.twin(h));
        if (sets.find(left) == sets.find(right)) {
            result.generators.push_back(h);
            continue;
        }
        sets.join(left, right);
        result.cotree[left].push_back(h);
        result.cotree[right].push_back(surface.twin(h));
    }
    return result;
}

}  // namespace couture::meshing
