#include "drivers/rom_learning_curve.h"

#include <algorithm>
#include <catch2/catch.hpp>

#include "rom/designs.h"

using namespace couture;

TEST_CASE("learning curve: every beginning of the order fills the space", "[drivers]") {
    // The 9 points of a square grid, in reading order: the middle, the corners, then the edges.
    const std::vector<int> order = drivers::space_filling_order(rom::full_design(2, 3));
    REQUIRE(order.size() == 9);
    CHECK(order.front() == 4);
    const std::vector<int> next(order.begin() + 1, order.begin() + 5);
    for (const int corner : {0, 2, 6, 8}) {
        CHECK(std::find(next.begin(), next.end(), corner) != next.end());
    }
    CHECK(drivers::space_filling_order(MatrixX::Zero(0, 2)).empty());
    CHECK(drivers::space_filling_order(MatrixX::Zero(3, 1)) == std::vector<int>{0, 1, 2});
}

TEST_CASE("learning curve: a part of snapshots keeps all solutions of its geometries",
          "[drivers]") {
    rom::Parameter size;
    size.name = "size";
    const rom::ParameterSpace parameters({size});
    rom::SnapshotSet set{parameters, {}, {}, {}, {}, {}, {}, {}};
    set.geometry_points = MatrixX{{0.0}, {0.5}, {1.0}};
    set.mechanics_factors = {MatrixX{{0.0}, {1.0}}};
    set.control_points = MatrixX{{1.0, 2.0, 3.0}};
    set.displacements = MatrixX{{10.0, 11.0, 20.0, 21.0, 30.0, 31.0}};
    const rom::SnapshotSet part = drivers::part_of(set, {2, 0});
    CHECK(part.geometry_points == MatrixX{{1.0}, {0.0}});
    CHECK(part.control_points == MatrixX{{3.0, 1.0}});
    CHECK(part.displacements == MatrixX{{30.0, 31.0, 10.0, 11.0}});
}
