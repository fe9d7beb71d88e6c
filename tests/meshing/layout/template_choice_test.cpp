#include "meshing/layout/template_choice.h"

#include <catch2/catch.hpp>
#include <limits>
#include <optional>
#include <random>

#include "iga/core/error.h"

using namespace couture;
using namespace couture::meshing;

namespace {

using Candidates = std::vector<std::vector<TemplateCandidate>>;

const CapPattern one = make_cap_pattern({{0, 1, 2, 3}});
const CapPattern two = make_cap_pattern({{0, 1, 4, 5}, {1, 2, 3, 4}});
const CapPattern three = make_cap_pattern({{0, 1, 6, 5}, {1, 2, 3, 6}, {3, 4, 5, 6}});

/// Least cost by trying all; nothing if none fits.
std::optional<double> least_cost(const Candidates& candidates) {
    std::optional<double> best;
    std::vector<std::size_t> pick(candidates.size(), 0);
    for (bool is_done = false; !is_done;) {
        std::map<int, std::vector<const CutDemand*>> sides;
        double cost = 0.0;
        for (std::size_t p = 0; p < pick.size(); ++p) {
            cost += candidates[p][pick[p]].cost;
            for (const auto& demand : candidates[p][pick[p]].cuts) {
                sides[demand.cut].push_back(&demand);
            }
        }
        const bool fits = std::ranges::all_of(sides, [](const auto& entry) {
            return matching_rotation(*entry.second[0], *entry.second[1]) >= 0;
        });
        if (fits && (!best || cost < *best)) best = cost;
        is_done = true;
        for (std::size_t p = 0; p < pick.size() && is_done; ++p) {
            pick[p] = (pick[p] + 1) % candidates[p].size();
            is_done = pick[p] == 0;
        }
    }
    return best;
}

}  // namespace

TEST_CASE("matching_rotation: places and quads must agree, orders are opposite", "[layout]") {
    CHECK(matching_rotation({0, one, {7, 8, 9, 10}}, {0, one, {7, 10, 9, 8}}) == 0);
    CHECK(matching_rotation({0, one, {7, 8, 9, 10}}, {0, one, {8, 7, 10, 9}}) == 1);
    CHECK(matching_rotation({0, one, {7, 8, 9, 10}}, {0, one, {7, 8, 9, 10}}) == -1);
    CHECK(matching_rotation({0, one, {7, 8, 9, 10}}, {0, two, {7, 8, 9, 10, 11, 12}}) == -1);
    // Six nodes around two quads and around three quads.
    CHECK(matching_rotation({0, two, {0, 1, 2, 3, 4, 5}}, {0, three, {0, 5, 4, 3, 2, 1}}) == -1);
    // The quads of two meet at loop nodes 1 and 4: only half the turns lay quads on quads.
    CHECK(matching_rotation({0, two, {0, 1, 2, 3, 4, 5}}, {0, two, {2, 1, 0, 5, 4, 3}}) == 2);
    CHECK(matching_rotation({0, two, {0, 1, 2, 3, 4, 5}}, {0, two, {1, 0, 5, 4, 3, 2}}) == -1);
}

TEST_CASE("choose_templates: the dearer template where its neighbour has no other", "[layout]") {
    const CutDemand low{5, one, {0, 1, 2, 3}};
    const CutDemand low_back{5, one, {0, 3, 2, 1}};
    const CutDemand wide{5, two, {0, 1, 2, 3, 4, 5}};
    const CutDemand wide_back{5, two, {0, 5, 4, 3, 2, 1}};
    CHECK(matching_rotation(wide, wide_back) == -1);
    const CutDemand wide_turned{5, two, {2, 1, 0, 5, 4, 3}};
    const Candidates candidates{{{1.0, {low}}, {4.0, {wide}}}, {{1.0, {wide_turned}}}};
    const TemplateChoice choice = choose_templates(candidates);
    CHECK(choice.candidates == std::vector{1, 0});
    CHECK(choice.cost == 5.0);
    CHECK(choice.rotations == std::map<int, int>{{5, 2}});
    CHECK(choose_templates({{{1.0, {low}}}, {{2.0, {wide_turned}}, {3.0, {low_back}}}}).cost ==
          4.0);
    // A patch that meets itself across the cut.
    CHECK(choose_templates({{{1.0, {low, low}}, {2.0, {low, low_back}}}}).candidates ==
          std::vector{1});
}

TEST_CASE("choose_templates: the least cost of all choices, on random graphs", "[layout]") {
    std::mt19937 random(7);
    const auto draw = [&](int n) { return static_cast<int>(random() % n); };
    int n_feasible = 0;
    int n_infeasible = 0;
    for (int trial = 0; trial < 60; ++trial) {
        const int n_patches = 3 + draw(3);
        std::vector<std::pair<int, int>> cuts;
        for (int p = 0; p < n_patches; ++p) cuts.emplace_back(p, (p + 1) % n_patches);
        cuts.emplace_back(0, n_patches / 2);
        Candidates candidates(n_patches);
        for (int p = 0; p < n_patches; ++p) {
            candidates[p].resize(2 + draw(4));
            for (auto& candidate : candidates[p]) {
                candidate.cost = 1.0 + draw(20);
                for (int c = 0; c < static_cast<int>(cuts.size()); ++c) {
                    if (cuts[c].first != p && cuts[c].second != p) continue;
                    const int shift = draw(2);
                    std::vector<int> places{shift, shift + 2, shift + 4, shift + 6};
                    if (cuts[c].second == p) std::ranges::reverse(places);
                    candidate.cuts.push_back({c, one, places});
                }
            }
        }
        const auto expected = least_cost(candidates);
        INFO(trial);
        if (expected) {
            ++n_feasible;
            CHECK(choose_templates(candidates).cost == *expected);
        } else {
            ++n_infeasible;
            CHECK_THROWS_AS(choose_templates(candidates), TopologyError);
        }
    }
    CHECK(n_feasible >= 10);
    CHECK(n_infeasible >= 10);
}

TEST_CASE("choose_templates: where nothing fits the cut is named", "[layout]") {
    const CutDemand a{0, one, {0, 1, 2, 3}};
    const CutDemand a_back{0, one, {3, 2, 1, 0}};
    const CutDemand b{1, one, {0, 1, 2, 3}};
    const CutDemand b_wide{1, two, {0, 1, 2, 3, 4, 5}};
    CHECK_THROWS_WITH(choose_templates({{{1.0, {a}}}, {{1.0, {a_back, b}}}, {{1.0, {b_wide}}}}),
                      "cut 1: no candidate of patch 1 (4 nodes on the cut) fits one of patch 2 (6 "
                      "nodes) that fits its other neighbours; give one of them another template");
    CHECK_THROWS_WITH(choose_templates({{{1.0, {a}}}, {}}), "patch 1 has no candidate templates");
    CHECK_THROWS_WITH(choose_templates({{{1.0, {a}}}, {{1.0, {b}}}}),
                      "cut 0 has one side only, in patch 0");
    CHECK_THROWS_WITH(choose_templates({{{1.0, {a}}}, {{1.0, {a_back}}}, {{1.0, {a}}}}),
                      "cut 0 has more than two sides, one of them in patch 2");
    CHECK_THROWS_WITH(choose_templates({{{1.0, {a}}, {1.0, {b}}}}),
                      "candidates 0 and 1 of patch 0 name different cuts");
    CHECK_THROWS_WITH(choose_templates({{{1.0, {{0, one, {0, 1}}}}}}),
                      "candidate 0 of patch 0 has 2 places for 4 nodes on cut 0");
}
