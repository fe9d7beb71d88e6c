#include "meshing/layout/cap_pattern.h"

#include <algorithm>

#include "iga/core/error.h"
#include "meshing/layout/quad_layout.h"

namespace couture::meshing {

namespace {

using HalfArc = std::pair<int, int>;

/// For each directed side its quad and its number there.
std::map<HalfArc, QuadLayout::ArcQuad> half_arcs(const CapPattern& pattern) {
    std::map<HalfArc, QuadLayout::ArcQuad> places;
    for (int q = 0; q < static_cast<int>(pattern.quads.size()); ++q) {
        for (int k = 0; k < 4; ++k) {
            places[{pattern.quads[q][k], pattern.quads[q][(k + 1) % 4]}] = {q, k};
        }
    }
    return places;
}

/// Lays quads on quads, from the boundary inwards.
class Matcher {
  public:
    Matcher(const CapPattern& first, const CapPattern& second)
        : first_(first),
          second_(second),
          first_places_(half_arcs(first)),
          second_places_(half_arcs(second)),
          is_laid_(first.quads.size(), false) {}

    std::optional<std::map<int, int>> match(int rotation) {
        const int n = static_cast<int>(first_.loop.size());
        for (int k = 0; k < n; ++k) {
            if (!pair(first_.loop[k], second_.loop[((rotation - k) % n + n) % n])) return {};
        }
        open_.push_back(first_places_.at({first_.loop[0], first_.loop[1]}).quad);
        is_laid_[open_.back()] = true;
        HalfArc known{first_.loop[0], first_.loop[1]};
        if (!lay(known)) return {};
        for (std::size_t i = 0; i < open_.size(); ++i) {
            const auto& quad = first_.quads[open_[i]];
            for (int k = 0; k < 4; ++k) {
                const auto beyond = first_places_.find({quad[(k + 1) % 4], quad[k]});
                if (beyond == first_places_.end() || is_laid_[beyond->second.quad]) continue;
                is_laid_[beyond->second.quad] = true;
                open_.push_back(beyond->second.quad);
                if (!lay(beyond->first)) return {};
            }
        }
        return node_;
    }

  private:
    bool pair(int a, int b) {
        return node_.emplace(a, b).first->second == b && back_.emplace(b, a).first->second == a;
    }

    /// Lays the quad left of a half arc whose nodes are paired.
    bool lay(const HalfArc& half_arc) {
        const auto& [quad, side] = first_places_.at(half_arc);
        const auto opposite =
            second_places_.find({node_.at(half_arc.second), node_.at(half_arc.first)});
        if (opposite == second_places_.end()) return false;
        const auto& corners = second_.quads[opposite->second.quad];
        for (int k = 0; k < 4; ++k) {
            if (!pair(first_.quads[quad][(side + k) % 4],
                      corners[(opposite->second.side + 5 - k) % 4])) {
                return false;
            }
        }
        return true;
    }

    const CapPattern& first_;
    const CapPattern& second_;
    std::map<HalfArc, QuadLayout::ArcQuad> first_places_;
    std::map<HalfArc, QuadLayout::ArcQuad> second_places_;
    std::vector<bool> is_laid_;
    std::vector<int> open_;
    std::map<int, int> node_;
    std::map<int, int> back_;
};

}  // namespace

CapPattern make_cap_pattern(std::vector<std::array<int, 4>> quads) {
    int n_nodes = 0;
    for (const auto& quad : quads) {
        n_nodes = std::max(n_nodes, *std::ranges::max_element(quad) + 1);
    }
    const QuadLayout layout(n_nodes, quads);
    const auto loops = boundary_loops(layout);
    if (loops.size() != 1 || layout.euler_characteristic() != 1) {
        throw TopologyError(
            "{} quads have {} boundary loops and Euler characteristic {}; a cap is a disc (1 and "
            "1)",
            layout.n_quads(), loops.size(), layout.euler_characteristic());
    }
    return {loops[0], std::move(quads)};
}

std::optional<std::map<int, int>> match_caps(const CapPattern& first, const CapPattern& second,
                                             int rotation) {
    if (first.loop.size() != second.loop.size() || first.quads.size() != second.quads.size()) {
        return {};
    }
    return Matcher(first, second).match(rotation);
}

std::vector<int> admissible_rotations(const CapPattern& first, const CapPattern& second) {
    std::vector<int> rotations;
    for (int r = 0; r < static_cast<int>(first.loop.size()); ++r) {
        if (match_caps(first, second, r)) rotations.push_back(r);
    }
    return rotations;
}

}  // namespace couture::meshing
