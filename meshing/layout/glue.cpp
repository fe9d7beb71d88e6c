#include "meshing/layout/glue.h"

#include <algorithm>
#include <set>

#include "iga/core/disjoint_sets.h"
#include "iga/core/error.h"

namespace couture::meshing {

namespace {

using Edge = std::pair<int, int>;

Edge edge_of(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

std::set<Edge> edges_of(const VolumetricLayout& layout) {
    std::set<Edge> edges;
    for (const auto& nodes : layout.cuboids) {
        for (int i = 0; i < 8; ++i) {
            for (int k = 0; k < 3; ++k) {
                if ((i >> k & 1) == 0) edges.insert(edge_of(nodes[i], nodes[i | 1 << k]));
            }
        }
    }
    return edges;
}

class Glue {
  public:
    Glue(const std::vector<CuboidTemplate>& patches, const std::vector<CapJoint>& joints)
        : patches_(patches), joints_(joints) {
        for (const CuboidTemplate& patch : patches) {
            first_node_.push_back(n_nodes_);
            n_nodes_ += patch.layout.n_nodes;
        }
    }

    GluedLayout glue() {
        DisjointSets sets(n_nodes_);
        for (int j = 0; j < static_cast<int>(joints_.size()); ++j) {
            use(joints_[j].first, j);
            use(joints_[j].second, j);
            for (const auto& [a, b] : matched_nodes(j)) {
                sets.join(first_node_[joints_[j].first.patch] + a,
                          first_node_[joints_[j].second.patch] + b);
            }
        }
        number_nodes(sets);
        add_cuboids();
        check_arcs();
        return std::move(result_);
    }

  private:
    void use(const PatchCap& cap, int joint) {
        if (cap.patch < 0 || cap.patch >= static_cast<int>(patches_.size()) || cap.cap < 0 ||
            cap.cap >= patches_[cap.patch].n_caps()) {
            throw InputError("joint {} names cap {} of patch {}, which does not exist", joint,
                             cap.cap, cap.patch);
        }
        if (!used_.insert(cap).second) {
            throw InputError("joint {} uses {} again; a cap is joined once", joint, name_of(cap));
        }
    }

    [[nodiscard]] std::string name_of(const PatchCap& cap) const {
        const CuboidTemplate& shape = patches_[cap.patch];
        return fmt::format("cap '{}' of patch {} (template '{}')", shape.caps[cap.cap], cap.patch,
                           shape.name);
    }

    [[nodiscard]] CapPattern pattern_of(const PatchCap& cap) const {
        return cap_pattern(patches_[cap.patch], cap.cap);
    }

    [[nodiscard]] std::map<int, int> matched_nodes(int j) const {
        const auto& [first, second, rotation] = joints_[j];
        const CapPattern a = pattern_of(first);
        const CapPattern b = pattern_of(second);
        if (rotation >= 0 && rotation < static_cast<int>(a.loop.size())) {
            if (const auto nodes = match_caps(a, b, rotation)) return *nodes;
        }
        const auto rotations = admissible_rotations(a, b);
        throw TopologyError(
            "joint {}: {} with {} quads and {} nodes around does not match {} with {} and {} at "
            "rotation {}; it would at {}",
            j, name_of(first), a.quads.size(), a.loop.size(), name_of(second), b.quads.size(),
            b.loop.size(), rotation,
            rotations.empty() ? "none" : fmt::format("{}", fmt::join(rotations, ", ")));
    }

    void number_nodes(DisjointSets& sets) {
        std::vector<int> number(n_nodes_, -1);
        for (std::size_t p = 0; p < patches_.size(); ++p) {
            auto& nodes = result_.nodes.emplace_back();
            for (int node = 0; node < patches_[p].layout.n_nodes; ++node) {
                int& there = number[sets.find(first_node_[p] + node)];
                if (there < 0) there = result_.layout.n_nodes++;
                nodes.push_back(there);
            }
        }
    }

    void add_cuboids() {
        VolumetricLayout& layout = result_.layout;
        for (int p = 0; p < static_cast<int>(patches_.size()); ++p) {
            const int first = layout.n_cuboids();
            result_.first_cuboid.push_back(first);
            for (std::array<int, 8> cuboid : patches_[p].layout.cuboids) {
                for (int& node : cuboid) node = result_.nodes[p][node];
                layout.cuboids.push_back(cuboid);
            }
            for (int cap = 0; cap < patches_[p].n_caps(); ++cap) {
                if (used_.contains({p, cap})) continue;
                auto& set = layout.sets[fmt::format("{}.{}", p, patches_[p].caps[cap])];
                for (const CuboidSide& side : patches_[p].cap_sides(cap)) {
                    set.push_back({first + side.cuboid, side.side});
                }
            }
        }
    }

    /// Arcs of patches become one only where caps are joined.
    void check_arcs() const {
        std::map<Edge, int> count;
        for (std::size_t p = 0; p < patches_.size(); ++p) {
            for (const auto& [a, b] : edges_of(patches_[p].layout)) {
                ++count[edge_of(result_.nodes[p][a], result_.nodes[p][b])];
            }
        }
        for (const CapJoint& joint : joints_) {
            const auto& nodes = result_.nodes[joint.first.patch];
            std::set<Edge> edges;
            for (const auto& quad : pattern_of(joint.first).quads) {
                for (int k = 0; k < 4; ++k) {
                    edges.insert(edge_of(nodes[quad[k]], nodes[quad[(k + 1) % 4]]));
                }
            }
            for (const Edge& edge : edges) --count[edge];
        }
        for (const auto& [edge, n] : count) {
            if (n == 1 && edge.first != edge.second) continue;
            const auto [patch, a, b] = place_of(edge);
            throw TopologyError(
                "nodes {} and {} of patch {} (template '{}') would be {}: joints stand too close "
                "to each other; choose a template with more cuboids between its caps",
                a, b, patch, patches_[patch].name,
                n == 1 ? "the same" : "the ends of two different arcs");
        }
    }

    struct EdgePlace {
        int patch, a, b;
    };
    [[nodiscard]] EdgePlace place_of(const Edge& edge) const {
        for (int p = 0; p < static_cast<int>(patches_.size()); ++p) {
            for (const auto& [a, b] : edges_of(patches_[p].layout)) {
                if (edge_of(result_.nodes[p][a], result_.nodes[p][b]) == edge) return {p, a, b};
            }
        }
        return {};
    }

    const std::vector<CuboidTemplate>& patches_;
    const std::vector<CapJoint>& joints_;
    std::vector<int> first_node_;
    int n_nodes_ = 0;
    std::set<PatchCap> used_;
    GluedLayout result_;
};

}  // namespace

GluedLayout glue_templates(const std::vector<CuboidTemplate>& patches,
                           const std::vector<CapJoint>& joints) {
    return Glue(patches, joints).glue();
}

}  // namespace couture::meshing
