#include "meshing/layout/template_choice.h"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <set>

#include "iga/core/error.h"

namespace couture::meshing {

namespace {

using Candidates = std::vector<std::vector<TemplateCandidate>>;

/// The two patches of a cut, and where their candidates say what they put on it.
struct CutSides {
    std::array<int, 2> patch{-1, -1};
    /// For each side and each candidate of its patch the number of the demand.
    std::array<std::vector<int>, 2> demand;
    [[nodiscard]] bool is_within_patch() const { return patch[0] == patch[1]; }
};

std::vector<int> sorted_cuts(const TemplateCandidate& candidate) {
    std::vector<int> cuts;
    for (const CutDemand& demand : candidate.cuts) cuts.push_back(demand.cut);
    std::ranges::sort(cuts);
    return cuts;
}

void check_candidates(const Candidates& candidates) {
    for (std::size_t p = 0; p < candidates.size(); ++p) {
        if (candidates[p].empty()) throw InputError("patch {} has no candidate templates", p);
        for (std::size_t c = 0; c < candidates[p].size(); ++c) {
            if (sorted_cuts(candidates[p][c]) != sorted_cuts(candidates[p][0])) {
                throw InputError("candidates 0 and {} of patch {} name different cuts", c, p);
            }
            for (const CutDemand& demand : candidates[p][c].cuts) {
                if (demand.places.size() != demand.pattern.loop.size()) {
                    throw InputError(
                        "candidate {} of patch {} has {} places for {} nodes on cut {}", c, p,
                        demand.places.size(), demand.pattern.loop.size(), demand.cut);
                }
            }
        }
    }
}

std::map<int, CutSides> find_cuts(const Candidates& candidates) {
    std::map<int, CutSides> cuts;
    for (int p = 0; p < static_cast<int>(candidates.size()); ++p) {
        for (std::size_t c = 0; c < candidates[p].size(); ++c) {
            const TemplateCandidate& candidate = candidates[p][c];
            std::set<int> met;
            for (int d = 0; d < static_cast<int>(candidate.cuts.size()); ++d) {
                const int cut = candidate.cuts[d].cut;
                CutSides& sides = cuts[cut];
                const bool starts =
                    sides.patch[0] < 0 || (sides.patch[0] == p && !met.contains(cut));
                const int side = starts ? 0 : 1;
                met.insert(cut);
                if ((sides.patch[side] >= 0 && sides.patch[side] != p) ||
                    sides.demand[side].size() > c) {
                    throw InputError("cut {} has more than two sides, one of them in patch {}", cut,
                                     p);
                }
                sides.patch[side] = p;
                sides.demand[side].push_back(d);
            }
        }
    }
    for (const auto& [cut, sides] : cuts) {
        if (sides.patch[1] < 0) {
            throw InputError("cut {} has one side only, in patch {}", cut, sides.patch[0]);
        }
    }
    return cuts;
}

class Search {
  public:
    explicit Search(const Candidates& candidates)
        : candidates_(candidates), cuts_(find_cuts(candidates)) {
        for (const auto& patch : candidates) domains_.emplace_back(patch.size(), true);
        for (const auto& [cut, sides] : cuts_) tabulate(cut, sides);
    }

    TemplateChoice choose() {
        if (!prune(domains_)) fail();
        descend(domains_);
        if (!best_) fail();
        for (const auto& [cut, sides] : cuts_) {
            best_->rotations[cut] =
                matching_rotation(demand(sides, 0, best_->candidates[sides.patch[0]]),
                                  demand(sides, 1, best_->candidates[sides.patch[1]]));
        }
        return *best_;
    }

  private:
    using Domain = std::vector<bool>;

    [[nodiscard]] const CutDemand& demand(const CutSides& sides, int side, int candidate) const {
        return candidates_[sides.patch[side]][candidate].cuts[sides.demand[side][candidate]];
    }

    /// Which candidates of the two patches match across a cut.
    void tabulate(int cut, const CutSides& sides) {
        const auto n_first = candidates_[sides.patch[0]].size();
        const auto n_second = candidates_[sides.patch[1]].size();
        auto& table = matches_[cut];
        table.assign(n_first, Domain(n_second, false));
        for (std::size_t i = 0; i < n_first; ++i) {
            for (std::size_t j = 0; j < n_second; ++j) {
                if (sides.is_within_patch() && i != j) continue;
                table[i][j] = matching_rotation(demand(sides, 0, static_cast<int>(i)),
                                                demand(sides, 1, static_cast<int>(j))) >= 0;
            }
        }
    }

    /// Drops candidates without a partner until none is left to drop. False if a patch has none
    /// left: then that cut is noted.
    bool prune(std::vector<Domain>& domains) {
        for (bool has_changed = true; has_changed;) {
            has_changed = false;
            for (const auto& [cut, sides] : cuts_) {
                for (int side = 0; side < 2; ++side) {
                    has_changed |= prune_side(domains, cut, sides, side);
                    const Domain& domain = domains[sides.patch[side]];
                    if (std::ranges::find(domain, true) != domain.end()) continue;
                    failed_cut_ = cut;
                    return false;
                }
            }
        }
        return true;
    }

    bool prune_side(std::vector<Domain>& domains, int cut, const CutSides& sides, int side) {
        Domain& domain = domains[sides.patch[side]];
        const Domain& other = domains[sides.patch[1 - side]];
        const auto& table = matches_.at(cut);
        bool has_changed = false;
        for (std::size_t i = 0; i < domain.size(); ++i) {
            if (!domain[i]) continue;
            bool has_partner = false;
            for (std::size_t j = 0; j < other.size() && !has_partner; ++j) {
                has_partner = other[j] && (side == 0 ? table[i][j] : table[j][i]);
            }
            if (has_partner) continue;
            domain[i] = false;
            has_changed = true;
        }
        return has_changed;
    }

    /// Candidates that are left, cheapest first.
    [[nodiscard]] std::vector<int> left(const Domain& domain, int patch) const {
        std::vector<int> numbers;
        for (int i = 0; i < static_cast<int>(domain.size()); ++i) {
            if (domain[i]) numbers.push_back(i);
        }
        std::ranges::stable_sort(numbers, {}, [&](int i) { return candidates_[patch][i].cost; });
        return numbers;
    }

    void descend(const std::vector<Domain>& domains) {
        TemplateChoice least;
        int narrowest = -1;
        std::vector<int> numbers;
        for (int p = 0; p < static_cast<int>(domains.size()); ++p) {
            const std::vector<int> there = left(domains[p], p);
            least.candidates.push_back(there[0]);
            least.cost += candidates_[p][there[0]].cost;
            if (there.size() > 1 && (narrowest < 0 || there.size() < numbers.size())) {
                narrowest = p;
                numbers = there;
            }
        }
        if (best_ && least.cost >= best_->cost) return;
        if (narrowest < 0) {
            best_ = std::move(least);
            return;
        }
        for (const int choice : numbers) {
            std::vector<Domain> narrowed = domains;
            narrowed[narrowest].assign(narrowed[narrowest].size(), false);
            narrowed[narrowest][choice] = true;
            if (prune(narrowed)) descend(narrowed);
        }
    }

    [[noreturn]] void fail() const {
        const CutSides& sides = cuts_.at(failed_cut_);
        const auto sizes = [&](int side) {
            std::set<std::size_t> counts;
            for (int i = 0; i < static_cast<int>(sides.demand[side].size()); ++i) {
                counts.insert(demand(sides, side, i).places.size());
            }
            return fmt::format("{}", fmt::join(counts, " or "));
        };
        throw TopologyError(
            "cut {}: no candidate of patch {} ({} nodes on the cut) fits one of patch {} ({} "
            "nodes) that fits its other neighbours; give one of them another template",
            failed_cut_, sides.patch[0], sizes(0), sides.patch[1], sizes(1));
    }

    const Candidates& candidates_;
    std::map<int, CutSides> cuts_;
    std::map<int, std::vector<Domain>> matches_;
    std::vector<Domain> domains_;
    std::optional<TemplateChoice> best_;
    int failed_cut_ = -1;
};

}  // namespace

int matching_rotation(const CutDemand& first, const CutDemand& second) {
    const int n = static_cast<int>(first.places.size());
    if (static_cast<int>(second.places.size()) != n) return -1;
    for (int rotation = 0; rotation < n; ++rotation) {
        bool agrees = true;
        for (int k = 0; k < n && agrees; ++k) {
            agrees = first.places[k] == second.places[((rotation - k) % n + n) % n];
        }
        if (agrees && match_caps(first.pattern, second.pattern, rotation)) return rotation;
    }
    return -1;
}

TemplateChoice choose_templates(const std::vector<std::vector<TemplateCandidate>>& candidates) {
    check_candidates(candidates);
    return Search(candidates).choose();
}

}  // namespace couture::meshing
