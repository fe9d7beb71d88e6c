#include "meshing/layout/divide_sheets.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <catch2/catch.hpp>

#include "iga/core/error.h"

using namespace couture;
using namespace couture::meshing;

namespace {

// Two unit cubes side by side along x, a face of each in a set.
PlacedLayout two_cubes() {
    PlacedLayout placed;
    placed.layout.n_nodes = 12;
    for (int i = 0; i < 12; ++i) placed.positions.emplace_back(i % 3, i / 3 % 2, i / 6);
    placed.layout.cuboids = {{0, 1, 3, 4, 6, 7, 9, 10}, {1, 2, 4, 5, 7, 8, 10, 11}};
    placed.layout.sets = {{"bottom", {{0, 4}, {1, 4}}}, {"left", {{0, 0}}}};
    return placed;
}

// Of straight cuboids, negative if they lie inside out.
double volume_of(const PlacedLayout& placed, int cuboid) {
    const auto& nodes = placed.layout.cuboids[cuboid];
    const auto edge = [&](int corner) {
        return Vector3(placed.positions[nodes[corner]] - placed.positions[nodes[0]]);
    };
    return edge(1).cross(edge(2)).dot(edge(4));
}

}  // namespace

TEST_CASE("divide_sheets: the sheet of an edge is divided, the others stay", "[layout]") {
    const PlacedLayout placed = two_cubes();
    // Along y: both cubes. The edge runs from (0, 0, 0) to (0, 1, 0).
    const PlacedLayout divided = divide_sheets(placed, {{{0, 3}, Vector3(0.0, 0.25, 0.0)}});
    CHECK(divided.layout.n_cuboids() == 4);
    CHECK(divided.layout.n_nodes == 12 + 6);
    CHECK(layout_boundary(divided.layout).sides.size() == 16);
    CHECK(divided.layout.sets.at("bottom").size() == 4);
    CHECK(divided.layout.sets.at("left").size() == 2);
    // The ratio spreads over the sheet.
    constexpr double spread = 1e-3;
    for (int c = 0; c < 4; ++c) {
        CHECK(volume_of(divided, c) == Approx(c % 2 == 0 ? 0.25 : 0.75).margin(spread));
    }
    for (int n = 0; n < 12; ++n) CHECK(divided.positions[n] == placed.positions[n]);
}

TEST_CASE("divide_sheets: cuboids with several divided directions have parts in all of them",
          "[layout]") {
    const auto middle = [](double x, double y, double z) { return Vector3(x, y, z); };
    const PlacedLayout divided = divide_sheets(two_cubes(), {{{0, 1}, middle(0.5, 0.0, 0.0)},
                                                             {{0, 3}, middle(0.0, 0.5, 0.0)},
                                                             {{0, 6}, middle(0.0, 0.0, 0.5)}});
    CHECK(divided.layout.n_cuboids() == 8 + 4);
    CHECK(divided.layout.n_nodes == 4 * 3 * 3);
    for (int c = 0; c < 12; ++c) CHECK(volume_of(divided, c) == Approx(c < 8 ? 0.125 : 0.25));
}

TEST_CASE("divide_sheets: edges with a path are divided at one of its points", "[layout]") {
    const Vector3 bulge(-0.2, 0.4, 0.0);
    const PlacedLayout divided =
        divide_sheets(two_cubes(), {{{1, 4}, Vector3(1.0, 0.5, 0.0)}},
                      {{{0, 3}, {Vector3(0.0, 0.0, 0.0), bulge, Vector3(0.0, 1.0, 0.0)}}});
    CHECK(std::ranges::count(divided.positions, bulge) == 1);
}

TEST_CASE("divide_sheets: refuses places on what is no edge", "[layout]") {
    CHECK_THROWS_WITH(divide_sheets(two_cubes(), {{{0, 4}, Vector3::Zero()}}),
                      "divide_sheets: nodes 0 and 4 are no edge of a cuboid");
}
