#include "meshing/volume/six_faces.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

namespace couture::meshing {

namespace {

using Quad = std::array<int, 4>;

std::pair<int, int> edge_of(int a, int b) { return std::minmax(a, b); }

class Search {
  public:
    explicit Search(std::span<const Quad> quads) : quads_(quads) {
        for (int q = 0; q < static_cast<int>(quads.size()); ++q) {
            Quad nodes = quads[q];
            for (int k = 0; k < 4; ++k) {
                at_edge_[edge_of(nodes[k], nodes[(k + 1) % 4])].push_back(q);
            }
            std::ranges::sort(nodes);
            of_nodes_[nodes] = q;
        }
    }

    // Goes round the sides of each quad, then closes with the opposite one.
    std::vector<SixFaces> run() {
        for (int q = 0; q < static_cast<int>(quads_.size()); ++q) {
            const auto& [a, b, c, d] = quads_[q];
            for (const int side_ab : at_edge_[edge_of(a, b)]) {
                const auto [e, f] = across(side_ab, a, b);
                for (const int side_bc : at_edge_[edge_of(b, c)]) {
                    const auto [f_again, g] = across(side_bc, b, c);
                    if (side_ab == q || side_bc == q || f_again != f) continue;
                    for (const int side_cd : at_edge_[edge_of(c, d)]) {
                        const auto [g_again, h] = across(side_cd, c, d);
                        if (side_cd == q || g_again != g) continue;
                        close({a, b, d, c, e, f, h, g}, q, {side_ab, side_bc, side_cd});
                    }
                }
            }
        }
        return std::move(found_);
    }

  private:
    // Nodes of a quad beside those of one of its edges.
    [[nodiscard]] std::pair<int, int> across(int quad, int a, int b) const {
        const Quad& nodes = quads_[quad];
        const auto at = std::ranges::find(nodes, a) - nodes.begin();
        const int after = nodes[(at + 1) % 4];
        const int before = nodes[(at + 3) % 4];
        const int opposite = nodes[(at + 2) % 4];
        return {after == b ? before : after, opposite};
    }

    // The quad that has these nodes in this cyclic order, -1 if there is none.
    [[nodiscard]] int find(const Quad& cycle) const {
        Quad nodes = cycle;
        std::ranges::sort(nodes);
        const auto place = of_nodes_.find(nodes);
        if (place == of_nodes_.end()) return -1;
        const auto [first, second] = across(place->second, cycle[0], cycle[1]);
        return first == cycle[3] && second == cycle[2] ? place->second : -1;
    }

    void close(const std::array<int, 8>& nodes, int bottom, const std::array<int, 3>& round) {
        const auto& [a, b, d, c, e, f, h, g] = nodes;
        if (std::set<int>(nodes.begin(), nodes.end()).size() != nodes.size()) return;
        const int last = find({d, a, e, h});
        const int top = find({e, f, g, h});
        if (last < 0 || top < 0) return;
        const SixFaces cuboid{nodes, {last, round[1], round[0], round[2], bottom, top}};
        auto key = cuboid.faces;
        std::ranges::sort(key);
        if (known_.insert(key).second) found_.push_back(cuboid);
    }

    std::span<const Quad> quads_;
    std::map<std::pair<int, int>, std::vector<int>> at_edge_;
    std::map<Quad, int> of_nodes_;
    std::set<std::array<int, 6>> known_;
    std::vector<SixFaces> found_;
};

}  // namespace

std::vector<SixFaces> find_six_faces(std::span<const Quad> quads) { return Search(quads).run(); }

SixFaces mirrored(SixFaces cuboid) {
    for (int i = 0; i < 8; i += 2) std::swap(cuboid.nodes[i], cuboid.nodes[i + 1]);
    std::swap(cuboid.faces[0], cuboid.faces[1]);
    return cuboid;
}

}  // namespace couture::meshing
