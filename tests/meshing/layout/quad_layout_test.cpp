#include "meshing/layout/quad_layout.h"

#include <catch2/catch.hpp>

#include "iga/core/error.h"
#include "meshing/layout/volumetric_layout.h"

using namespace couture;
using namespace couture::meshing;

namespace {

// n cuboids in a row along the first direction.
VolumetricLayout bar(int n) {
    VolumetricLayout layout;
    layout.n_nodes = 4 * (n + 1);
    for (int c = 0; c < n; ++c) {
        const int a = 4 * c;
        layout.cuboids.push_back({a, a + 4, a + 1, a + 5, a + 2, a + 6, a + 3, a + 7});
    }
    return layout;
}

}  // namespace

TEST_CASE("quad layout: the boundary of a bar of cuboids", "[layout]") {
    const LayoutBoundary boundary = layout_boundary(bar(3));
    const QuadLayout& layout = boundary.layout;
    CHECK(layout.n_quads() == 14);
    CHECK(layout.n_arcs() == 28);
    CHECK(layout.n_nodes() - layout.n_arcs() + layout.n_quads() == 2);
    int n_three = 0;
    for (const int valence : layout.valences()) {
        n_three += valence == 3 ? 1 : 0;
        CHECK((valence == 3 || valence == 4));
    }
    CHECK(n_three == 8);
    // Two sheets around the section, one for each cuboid along the bar.
    const std::vector<int> sheets = layout.sheets();
    CHECK(*std::max_element(sheets.begin(), sheets.end()) + 1 == 5);
    for (int q = 0; q < layout.n_quads(); ++q) {
        for (int k = 0; k < 4; ++k) {
            const QuadLayout::Side side = layout.sides(q)[k];
            const QuadLayout::Arc& arc = layout.arcs()[side.arc];
            CHECK((side.is_forward ? arc.from : arc.to) == layout.quads()[q][k]);
            CHECK_FALSE(layout.is_boundary_arc(side.arc));
        }
    }
}

TEST_CASE("quad layout: what is no layout is refused", "[layout]") {
    CHECK_THROWS_AS(QuadLayout(4, {{0, 1, 2, 2}}), InputError);
    CHECK_THROWS_AS(QuadLayout(3, {{0, 1, 2, 3}}), InputError);
    CHECK_THROWS_AS(QuadLayout(6, {{0, 1, 2, 3}, {0, 1, 4, 5}}), TopologyError);
    VolumetricLayout twice = bar(2);
    twice.cuboids.push_back(twice.cuboids[0]);
    CHECK_THROWS_AS(layout_boundary(twice), TopologyError);
    VolumetricLayout mirrored = bar(2);
    mirrored.cuboids[1] = {4, 8, 6, 10, 5, 9, 7, 11};
    CHECK_THROWS_AS(layout_boundary(mirrored), TopologyError);
}
