#include "meshing/layout/cut_turns.h"

#include <catch2/catch.hpp>
#include <numeric>

#include "meshing/layout/cuboid_decomposition.h"
#include "meshing/layout/layout_choice.h"
#include "meshing/parameterization/sheet_sizes.h"
#include "tests/meshing/layout/cut_parts.h"

using namespace couture;
using namespace couture::meshing;

namespace {

// Of all arcs on the surface.
double drawn_length(const Job& job) {
    const CuboidDecomposition cuboids =
        decompose_into_cuboids(job.opened, job.features, job.pants, job.caps, some_templates());
    const std::vector<double> lengths = arc_lengths(cuboids.mesh, cuboids.surface);
    return std::accumulate(lengths.begin(), lengths.end(), 0.0);
}

}  // namespace

TEST_CASE("cut turns: where a curve's vertices begin does not matter", "[layout]") {
    // Nodes lie at vertices of the curves.
    constexpr double tolerance = 0.03;
    Job job = cut_part("double_torus", {}, 4.0);
    const double length = drawn_length(job);
    for (PantsCurve& curve : job.pants.curves) {
        auto& vertices = curve.curve.vertices;
        std::ranges::rotate(vertices, vertices.begin() + static_cast<long>(vertices.size()) / 6);
    }
    CHECK(drawn_length(job) == Approx(length).epsilon(tolerance));
}

TEST_CASE("cut turns: both sides of a cut begin at one vertex, and caps match there", "[layout]") {
    const Job job = cut_part("double_torus", {}, 4.0);
    const TemplateLibrary library = some_templates();
    std::vector<PatchFeatures> patches = find_patch_features(job.opened, job.features, job.pants);
    LayoutChoice choice = choose_layout(job.opened, patches, job.pants, library);
    turn_smooth_cuts(job.opened, job.pants, library, patches, choice);
    std::map<int, std::vector<std::array<int, 2>>> sides;
    for (int p = 0; p < static_cast<int>(patches.size()); ++p) {
        for (int l = 0; l < static_cast<int>(patches[p].loops.size()); ++l) {
            sides[patches[p].loops[l].side.curve].push_back({p, l});
        }
    }
    REQUIRE(sides.size() == 3);
    for (const auto& [curve, both] : sides) {
        REQUIRE(both.size() == 2);
        std::array<CapPattern, 2> caps;
        std::array<int, 2> firsts{};
        for (int i = 0; i < 2; ++i) {
            const auto [p, l] = both[i];
            caps[i] = cap_pattern(library.find(choice.templates[p]), choice.matches[p].caps[l]);
            firsts[i] = choice.matches[p].loop_nodes[l][0];
        }
        CHECK(patches[both[0][0]].loops[both[0][1]].vertices[0] ==
              patches[both[1][0]].loops[both[1][1]].vertices[0]);
        const auto nodes = match_caps(caps[0], caps[1], choice.rotations.at(curve));
        REQUIRE(nodes);
        CHECK(nodes->at(firsts[0]) == firsts[1]);
    }
}
