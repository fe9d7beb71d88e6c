#include "meshing/volume/layout_cells.h"

#include <algorithm>
#include <catch2/catch.hpp>

#include "meshing/layout/polycube_templates.h"
#include "tests/meshing/layout/layout_samples.h"

using namespace couture;
using namespace couture::meshing;

TEST_CASE("make_layout_cells: as many sheets as there are planes of cubes", "[volume]") {
    const VolumetricLayout tee = make_bar_template("tee", {{0, 0}}, {{{0, 0}}}).layout;
    const LayoutCells cells = make_layout_cells(tee);
    CHECK(cells.n_sheets() == 3 + 2 + 1);
    CHECK(make_layout_cells(make_star_template("star", 6).layout).n_sheets() == 9);
    // A ring: one sheet for each cuboid along it, two across.
    CHECK(make_layout_cells(test::ring_of_cuboids(5)).n_sheets() == 7);
    // On the outside sheets are those of the boundary.
    const std::vector<int> outer = layout_boundary(tee).layout.sheets();
    CHECK(*std::ranges::max_element(outer) + 1 == cells.n_sheets());
    // Counted from 0 in the order of their first edges.
    int next = 0;
    for (const int sheet : cells.sheets) {
        CHECK(sheet <= next);
        next = std::max(next, sheet + 1);
    }
    CHECK(next == cells.n_sheets());
}
