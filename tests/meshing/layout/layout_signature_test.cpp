#include "meshing/layout/layout_signature.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <set>

#include "iga/core/error.h"
#include "meshing/layout/polycube_templates.h"
#include "tests/meshing/layout/layout_samples.h"

using namespace couture;
using namespace couture::meshing;

namespace {

int n_sheets(const VolumetricLayout& layout) {
    std::set<int> numbers;
    for (const auto& sheets : cuboid_sheets(layout)) numbers.insert(sheets.begin(), sheets.end());
    CHECK(*numbers.rbegin() + 1 == static_cast<int>(numbers.size()));
    return static_cast<int>(numbers.size());
}

}  // namespace

TEST_CASE("cuboid_sheets: as many as there are planes of cubes", "[layout]") {
    const VolumetricLayout tee = make_bar_template("tee", {{0, 0}}, {{{0, 0}}}).layout;
    CHECK(n_sheets(tee) == 3 + 2 + 1);
    CHECK(n_sheets(make_star_template("star", 6).layout) == 9);
    // A ring: one sheet for each cuboid along it, two across.
    CHECK(n_sheets(test::ring_of_cuboids(5)) == 7);
    // On the outside sheets are those of the boundary.
    const LayoutBoundary boundary = layout_boundary(tee);
    const std::vector<int> outer = boundary.layout.sheets();
    CHECK(*std::ranges::max_element(outer) + 1 == 6);
    CHECK(cuboid_sheets(tee)[0] == std::array{0, 1, 2});
}

TEST_CASE("layout_signature: nodes, sets and elements count, the order of sides does not",
          "[layout]") {
    const VolumetricLayout wide =
        make_bar_template("wide", {{0, 0}, {0, 1}}, {{{0, 0}, {0, 1}}}).layout;
    const std::vector<int> n_cells(n_sheets(wide), 2);
    const std::string signature = layout_signature(wide, n_cells);
    CHECK(signature.size() == 16);

    VolumetricLayout other = wide;
    std::ranges::reverse(other.sets.at("branch"));
    CHECK(layout_signature(other, n_cells) == signature);
    other.sets["branch"].pop_back();
    CHECK(layout_signature(other, n_cells) != signature);
    other = wide;
    std::swap(other.cuboids[0], other.cuboids[1]);
    CHECK(layout_signature(other, n_cells) != signature);
    std::vector<int> finer = n_cells;
    finer[3] = 3;
    CHECK(layout_signature(wide, finer) != signature);

    finer.push_back(1);
    CHECK_THROWS_WITH(layout_signature(wide, finer),
                      "layout_signature: elements of 8 sheets; the layout has 7");
    finer.pop_back();
    finer[1] = 0;
    CHECK_THROWS_AS(layout_signature(wide, finer), InputError);
}
