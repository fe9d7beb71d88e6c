#include "meshing/layout/divide_sheets.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "iga/core/disjoint_sets.h"
#include "iga/core/error.h"

namespace couture::meshing {

namespace {

// Corner at the low end of edge i of a direction.
int low_corner(int direction, int i) {
    const int a = direction == 0 ? 1 : 0;
    const int b = direction == 2 ? 1 : 2;
    return (i & 1) << a | (i >> 1) << b;
}

// The point between the ends of a path that is nearest to a fraction of its length.
Vector3 inner_point(const std::vector<Vector3>& path, double fraction) {
    std::vector<double> lengths = {0.0};
    for (std::size_t k = 1; k < path.size(); ++k) {
        lengths.push_back(lengths.back() + (path[k] - path[k - 1]).norm());
    }
    std::size_t best = 1;
    for (std::size_t k = 1; k + 1 < path.size(); ++k) {
        const auto distance = [&](std::size_t i) {
            return std::abs(lengths[i] - fraction * lengths.back());
        };
        if (distance(k) < distance(best)) best = k;
    }
    return path[best];
}

// Divides the sheets of a layout that have new nodes.
class SheetDivider {
  public:
    SheetDivider(const PlacedLayout& placed, const EdgePlaces& places, const EdgePaths& paths)
        : old_(placed),
          paths_(paths),
          result_{{placed.layout.n_nodes, {}, {}, placed.layout.node_names}, placed.positions} {
        number_edges();
        choose_sheets(places);
        spread_fractions();
    }

    PlacedLayout divide() {
        std::vector<int> first_part;
        for (int c = 0; c < old_.layout.n_cuboids(); ++c) {
            first_part.push_back(result_.layout.n_cuboids());
            add_parts(c);
        }
        for (const auto& [name, sides] : old_.layout.sets) {
            for (const CuboidSide& side : sides) add_parts_of_side(name, side, first_part);
        }
        return std::move(result_);
    }

  private:
    void number_edges() {
        for (const std::array<int, 8>& cuboid : old_.layout.cuboids) {
            auto& of_cuboid = cuboid_edges_.emplace_back();
            for (int i = 0; i < 12; ++i) {
                const int low = low_corner(i / 4, i % 4);
                const int from = cuboid[low];
                const int to = cuboid[low | 1 << (i / 4)];
                const auto [found, is_new] =
                    edge_of_nodes_.try_emplace(std::minmax(from, to), edges_.size());
                if (is_new) edges_.push_back({std::min(from, to), std::max(from, to)});
                of_cuboid[i] = {found->second, from > to};
            }
        }
    }

    void choose_sheets(const EdgePlaces& places) {
        DisjointSets sheets(edges_.size());
        for (const auto& of_cuboid : cuboid_edges_) {
            for (int i = 0; i < 12; ++i) sheets.join(of_cuboid[i].number, of_cuboid[i & ~3].number);
        }
        std::vector<bool> is_chosen(edges_.size(), false);
        given_.resize(edges_.size());
        for (const auto& [nodes, place] : places) {
            const auto found = edge_of_nodes_.find({nodes[0], nodes[1]});
            if (found == edge_of_nodes_.end()) {
                throw InputError("divide_sheets: nodes {} and {} are no edge of a cuboid", nodes[0],
                                 nodes[1]);
            }
            given_[found->second] = place;
            is_chosen[sheets.find(found->second)] = true;
        }
        for (std::size_t e = 0; e < edges_.size(); ++e) {
            is_divided_.push_back(is_chosen[sheets.find(static_cast<int>(e))]);
        }
    }

    // Where edges without a given place are divided.
    void spread_fractions() {
        fractions_.assign(edges_.size(), 0.5);
        for (std::size_t e = 0; e < edges_.size(); ++e) {
            if (!given_[e]) continue;
            const Vector3& from = old_.positions[edges_[e][0]];
            const Vector3 d = old_.positions[edges_[e][1]] - from;
            constexpr double near_end = 0.1;
            fractions_[e] =
                std::clamp((*given_[e] - from).dot(d) / d.squaredNorm(), near_end, 1.0 - near_end);
        }
        constexpr int n_sweeps = 100;
        for (int sweep = 0; sweep < n_sweeps; ++sweep) spread_once();
    }

    void spread_once() {
        std::vector<double> sums(edges_.size(), 0.0);
        std::vector<int> counts(edges_.size(), 0);
        for (const auto& of_cuboid : cuboid_edges_) {
            for (int i = 0; i < 12; ++i) {
                // Those that share a face with it.
                for (const int other : {i ^ 1, i ^ 2}) {
                    const double fraction = fractions_[of_cuboid[other].number];
                    const bool is_turned = of_cuboid[i].is_reversed != of_cuboid[other].is_reversed;
                    sums[of_cuboid[i].number] += is_turned ? 1.0 - fraction : fraction;
                    ++counts[of_cuboid[i].number];
                }
            }
        }
        for (std::size_t e = 0; e < edges_.size(); ++e) {
            if (!given_[e]) fractions_[e] = sums[e] / counts[e];
        }
    }

    [[nodiscard]] Vector3 place_of_edge(int e) const {
        if (given_[e]) return *given_[e];
        const auto path = paths_.find(edges_[e]);
        if (path != paths_.end() && path->second.size() > 2) {
            return inner_point(path->second, fractions_[e]);
        }
        return (1.0 - fractions_[e]) * old_.positions[edges_[e][0]] +
               fractions_[e] * old_.positions[edges_[e][1]];
    }

    // The node amid an edge, a face or a cuboid: of its nodes, at a mean over its edges that are
    // divided.
    int node_amid(std::vector<int> nodes) {
        std::ranges::sort(nodes);
        const auto [found, is_new] = node_amid_.try_emplace(nodes, result_.layout.n_nodes);
        if (!is_new) return found->second;
        Vector3 sum = Vector3::Zero();
        int count = 0;
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            for (std::size_t j = i + 1; j < nodes.size(); ++j) {
                const auto edge = edge_of_nodes_.find({nodes[i], nodes[j]});
                if (edge == edge_of_nodes_.end()) continue;
                sum += place_of_edge(edge->second);
                ++count;
            }
        }
        result_.positions.push_back(sum / count);
        return result_.layout.n_nodes++;
    }

    // The node at one of three places per direction of a cuboid: low, middle, high.
    int node_at(int cuboid, const std::array<int, 3>& at) {
        std::vector<int> nodes;
        for (int corner = 0; corner < 8; ++corner) {
            bool is_part = true;
            for (int k = 0; k < 3; ++k) {
                is_part = is_part && (at[k] == 1 || (corner >> k & 1) == at[k] / 2);
            }
            if (is_part) nodes.push_back(old_.layout.cuboids[cuboid][corner]);
        }
        return nodes.size() == 1 ? nodes[0] : node_amid(std::move(nodes));
    }

    [[nodiscard]] std::array<int, 3> n_parts(int cuboid) const {
        std::array<int, 3> n{};
        for (int k = 0; k < 3; ++k) n[k] = is_divided_[cuboid_edges_[cuboid][4 * k].number] ? 2 : 1;
        return n;
    }

    void add_parts(int cuboid) {
        const std::array<int, 3> n = n_parts(cuboid);
        for (int part = 0; part < n[0] * n[1] * n[2]; ++part) {
            const std::array<int, 3> p = {part % n[0], part / n[0] % n[1], part / (n[0] * n[1])};
            std::array<int, 8> nodes{};
            for (int corner = 0; corner < 8; ++corner) {
                std::array<int, 3> at{};
                for (int k = 0; k < 3; ++k)
                    at[k] = (p[k] + (corner >> k & 1)) * (n[k] == 1 ? 2 : 1);
                nodes[corner] = node_at(cuboid, at);
            }
            result_.layout.cuboids.push_back(nodes);
        }
    }

    void add_parts_of_side(const std::string& name, const CuboidSide& side,
                           const std::vector<int>& first_part) {
        const std::array<int, 3> n = n_parts(side.cuboid);
        const int k = side.side / 2;
        for (int part = 0; part < n[0] * n[1] * n[2]; ++part) {
            const std::array<int, 3> p = {part % n[0], part / n[0] % n[1], part / (n[0] * n[1])};
            if (p[k] != (side.side % 2 == 0 ? 0 : n[k] - 1)) continue;
            result_.layout.sets[name].push_back({first_part[side.cuboid] + part, side.side});
        }
    }

    struct CuboidEdge {
        int number;
        // Whether the direction of the cuboid runs from the larger node.
        bool is_reversed;
    };

    const PlacedLayout& old_;
    const EdgePaths& paths_;
    PlacedLayout result_;
    std::vector<std::array<int, 2>> edges_;
    std::map<std::pair<int, int>, int> edge_of_nodes_;
    // 4 per direction, by their low corners.
    std::vector<std::array<CuboidEdge, 12>> cuboid_edges_;
    std::vector<bool> is_divided_;
    std::vector<std::optional<Vector3>> given_;
    // From the smaller node.
    std::vector<double> fractions_;
    std::map<std::vector<int>, int> node_amid_;
};

}  // namespace

PlacedLayout divide_sheets(const PlacedLayout& placed, const EdgePlaces& places,
                           const EdgePaths& paths) {
    return SheetDivider(placed, places, paths).divide();
}

}  // namespace couture::meshing
