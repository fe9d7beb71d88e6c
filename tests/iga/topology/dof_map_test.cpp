#include "iga/topology/dof_map.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <set>

#include "iga/core/error.h"
#include "tests/iga/topology/test_patches.h"

using namespace couture;
using namespace couture::iga;

namespace {

template <int d>
DofMap dofs_of(const MultiPatch<d>& multipatch) {
    std::vector<TensorSpace<d>> spaces;
    for (const Patch<d>& patch : multipatch.patches) {
        spaces.push_back(patch.space());
    }
    return make_dof_map(multipatch, spaces);
}

/// Unit cube with its control points moved by `map`.
template <typename Map>
MultiPatch<3> mapped_cube(int degree, int n_elements, const Map& map) {
    const Patch<3> box = make_unit_box<3>(degree, n_elements);
    MatrixX points = box.control_points();
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
        points.row(i) = map(Vector3(points.row(i).transpose())).transpose();
    }
    return {{Patch<3>(box.space(), points)}, {}, {}};
}

}  // namespace

TEST_CASE("make_dof_map: shared functions are numbered at their first occurrence", "[topology]") {
    const MultiPatch<2> pair{{make_unit_box<2>(1, 1), make_unit_box<2>(1, 1, {1.0, 0.0})},
                             {{0, 1, 1, 0, SideMap<2>::identity()}},
                             {}};
    const DofMap map = dofs_of(pair);
    CHECK(map.n_dofs == 6);
    CHECK(map.global[0] == std::vector<int>{0, 1, 2, 3});
    CHECK(map.global[1] == std::vector<int>{1, 4, 3, 5});
}

TEST_CASE("make_dof_map: shared functions have the same control point, others have not",
          "[topology]") {
    // 2 x 2 x 2 cubes around a point, quadratic, numbered without looking at positions.
    MultiPatch<3> grid;
    for (int i = 0; i < 8; ++i) {
        grid.patches.push_back(
            make_unit_box<3>(2, 2, Vector3(i % 2, (i / 2) % 2, static_cast<double>(i / 4))));
    }
    for (int i = 0; i < 8; ++i) {
        for (int k = 0; k < 3; ++k) {
            if (((i >> k) & 1) == 0) {
                grid.interfaces.push_back(
                    {i, 2 * k + 1, i | (1 << k), 2 * k, SideMap<3>::identity()});
            }
        }
    }
    const DofMap map = dofs_of(grid);
    CHECK(map.n_dofs == 7 * 7 * 7);
    std::vector<Vector3> position(map.n_dofs, Vector3::Constant(-1.0));
    for (int p = 0; p < 8; ++p) {
        for (int i = 0; i < grid.patches[p].space().n_basis(); ++i) {
            const Vector3 x = grid.patches[p].control_points().row(i).transpose();
            Vector3& known = position[map.global[p][i]];
            CHECK((known[0] < 0.0 || (known - x).norm() < 1e-14));
            known = x;
        }
    }
}

TEST_CASE("make_dof_map: a patch glued to itself", "[topology]") {
    // Opposite sides of a square taken as one: a ring, then a torus.
    MultiPatch<2> square{{make_unit_box<2>(2, 3)}, {{0, 0, 0, 1, SideMap<2>::identity()}}, {}};
    CHECK(dofs_of(square).n_dofs == 4 * 5);
    square.interfaces.push_back({0, 2, 0, 3, SideMap<2>::identity()});
    CHECK(dofs_of(square).n_dofs == 4 * 4);
    // Glued backwards: a Moebius band.
    square.interfaces = {{0, 0, 0, 1, {{0}, {true}}}};
    CHECK(dofs_of(square).n_dofs == 4 * 5);
}

TEST_CASE("make_dof_map: collapsed sides and edges share their functions", "[topology]") {
    constexpr int n = 4;  // functions per direction
    SECTION("a wedge: a side is an edge") {
        const MultiPatch<3> wedge =
            mapped_cube(2, 2, [](const Vector3& x) { return Vector3(x[0], x[0] * x[1], x[2]); });
        CHECK(dofs_of(wedge).n_dofs == n * n * n - n * (n - 1));
        const auto collapsed = collapsed_entities(wedge);
        REQUIRE(collapsed.size() == 1);
        CHECK(collapsed[0].name() == "patch 0 side 0:low collapses in direction 1");
    }
    SECTION("a cone: a side is a point") {
        const MultiPatch<3> cone = mapped_cube(
            2, 2, [](const Vector3& x) { return Vector3(x[0], x[0] * x[1], x[0] * x[2]); });
        CHECK(dofs_of(cone).n_dofs == n * n * n - n * n + 1);
        const auto collapsed = collapsed_entities(cone);
        REQUIRE(collapsed.size() == 1);
        CHECK(collapsed[0].name() == "patch 0 side 0:low collapses in directions 1 and 2");
    }
    SECTION("a single edge is a point") {
        const MultiPatch<3> edge = mapped_cube(2, 2, [](const Vector3& x) {
            return Vector3(x[0], x[1], x[2] * std::max(x[0], x[1]));
        });
        CHECK(dofs_of(edge).n_dofs == n * n * n - (n - 1));
        const auto collapsed = collapsed_entities(edge);
        REQUIRE(collapsed.size() == 1);
        CHECK(collapsed[0].name() == "patch 0 edge 0:low 1:low collapses in direction 2");
    }
    SECTION("a pole on a finer field space") {
        const MultiPatch<3> wedge =
            mapped_cube(1, 1, [](const Vector3& x) { return Vector3(x[0], x[0] * x[1], x[2]); });
        const KnotVector fine = KnotVector::uniform(3, 2);
        CHECK(make_dof_map<3>(wedge, {{{fine, fine, fine}}}).n_dofs == 125 - 5 * 4);
    }
    SECTION("short is not collapsed") {
        constexpr double thin = 1e-6;
        const MultiPatch<3> slab =
            mapped_cube(1, 1, [](const Vector3& x) { return Vector3(x[0], thin * x[1], x[2]); });
        CHECK(dofs_of(slab).n_dofs == 8);
        CHECK(collapsed_entities(slab).empty());
    }
}

TEST_CASE("make_dof_map: spaces that do not conform are named", "[topology]") {
    const MultiPatch<2> pair{{make_unit_box<2>(1, 1), make_unit_box<2>(1, 1, {1.0, 0.0})},
                             {{0, 1, 1, 0, SideMap<2>::identity()}},
                             {}};
    const KnotVector one = KnotVector::uniform(1, 1);
    const KnotVector two = KnotVector::uniform(1, 2);
    CHECK_THROWS_WITH(make_dof_map<2>(pair, {{{one, one}}, {{one, two}}}),
                      "make_dof_map: spaces on patch 0 side 0:high and patch 1 side 0:low do not "
                      "conform in direction 1 of patch 0; degrees and knots must be equal up to "
                      "scale");
    CHECK_THROWS_AS(make_dof_map<2>(pair, {{{one, one}}, {{one, two}}}), TopologyError);
    CHECK_THROWS_WITH(make_dof_map<2>(pair, {{{one, one}}}),
                      "make_dof_map: 1 spaces for 2 patches; each patch takes one");
}
