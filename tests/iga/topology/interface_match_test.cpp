#include "iga/topology/interface_match.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "iga/core/error.h"
#include "iga/core/timer.h"
#include "iga/topology/dof_map.h"
#include "tests/iga/topology/test_patches.h"

using namespace couture;
using namespace couture::iga;

namespace {

/// Knots that read differently backwards, and differ between directions.
TensorSpace<3> lopsided_space() {
    return {{KnotVector(2, {0, 0, 0, 0.3, 1, 1, 1}), KnotVector(2, {0, 0, 0, 0.2, 0.6, 1, 1, 1}),
             KnotVector(1, {0, 0, 0.4, 0.5, 1, 1})}};
}

DofMap dofs_of(const auto& multipatch) {
    std::vector<std::decay_t<decltype(multipatch.patches[0].space())>> spaces;
    for (const auto& patch : multipatch.patches) {
        spaces.push_back(patch.space());
    }
    return make_dof_map(multipatch, spaces);
}

/// Rational ring sector (linear across, one quadratic arc along) between two angles.
Patch<2> sector(double inner, double outer, double start, double sweep, int n_arcs) {
    std::vector<double> knots(3, 0.0);
    for (int i = 1; i < n_arcs; ++i) {
        knots.insert(knots.end(), 2, static_cast<double>(i) / n_arcs);
    }
    knots.insert(knots.end(), 3, 1.0);
    const double half = sweep / (2 * n_arcs);
    const int n = 2 * n_arcs + 1;
    MatrixX points(2 * n, 2);
    VectorX weights(2 * n);
    for (int j = 0; j < n; ++j) {
        const double w = j % 2 == 1 ? std::cos(half) : 1.0;
        const double angle = start + half * j;
        for (int i = 0; i < 2; ++i) {
            const double r = (i == 0 ? inner : outer) / w;
            points.row(2 * j + i) << r * std::cos(angle), r * std::sin(angle);
            weights[2 * j + i] = w;
        }
    }
    return {{{KnotVector::uniform(1, 1), KnotVector(2, knots)}}, points, weights};
}

Patch<3> bilinear_column(const std::array<Vector2, 4>& corners) {
    MatrixX points(8, 3);
    for (int i = 0; i < 8; ++i) {
        points.row(i) << corners[i % 4].transpose(), static_cast<double>(i / 4);
    }
    const KnotVector knots = KnotVector::uniform(1, 1);
    return {{{knots, knots, knots}}, points};
}

}  // namespace

TEST_CASE("find_interfaces: two cubes in all positions to each other", "[topology]") {
    const Patch<3> first =
        make_mapped_patch<3>(lopsided_space(), [](const Vector3& xi) { return VectorX(xi); });
    int n_cases = 0;
    for (int side = 0; side < 6; ++side) {
        const int direction = side_direction(side);
        // The neighbour mirrors the cube in this direction, so that knots agree all around.
        const Patch<3> neighbour = make_mapped_patch<3>(lopsided_space(), [&](const Vector3& xi) {
            Vector3 x = xi;
            x[direction] = (side_is_high(side) ? 2.0 : 0.0) - x[direction];
            return VectorX(x);
        });
        std::array<int, 3> axis{0, 1, 2};
        do {
            for (int flips = 0; flips < 8; ++flips) {
                const std::array<bool, 3> reversed{(flips & 1) != 0, (flips & 2) != 0,
                                                   (flips & 4) != 0};
                MultiPatch<3> pair{{first, reoriented<3>(neighbour, axis, reversed)}, {}, {}};
                CHECK(find_interfaces(pair).empty());
                REQUIRE(pair.interfaces.size() == 1);
                const Interface<3>& interface = pair.interfaces[0];
                CHECK(interface.first_patch == 0);
                CHECK(interface.first_side == side);
                CHECK(axis[side_direction(interface.second_side)] == direction);
                check(pair);
                const int n_shared = first.space().n_basis() / first.knots(direction).n_basis();
                CHECK(dofs_of(pair).n_dofs == 2 * first.space().n_basis() - n_shared);
                // Nothing was refined.
                CHECK(pair.patches[0].space() == first.space());
                ++n_cases;
            }
        } while (std::next_permutation(axis.begin(), axis.end()));
    }
    CHECK(n_cases == 6 * 48);
}

TEST_CASE("find_interfaces: a disc of five patches, extruded", "[topology]") {
    // A square core and four patches around it.
    const auto corner = [](int i, double radius) {
        const double angle = std::numbers::pi * (0.25 + 0.5 * i);
        return Vector2(radius * std::cos(angle), radius * std::sin(angle));
    };
    MultiPatch<3> disc;
    disc.patches.push_back(
        bilinear_column({corner(2, 1), corner(3, 1), corner(1, 1), corner(0, 1)}));
    for (int i = 0; i < 4; ++i) {
        disc.patches.push_back(
            bilinear_column({corner(i, 1), corner(i + 1, 1), corner(i, 2), corner(i + 1, 2)}));
    }
    CHECK(find_interfaces(disc).empty());
    CHECK(disc.interfaces.size() == 8);
    check(disc);
    CHECK(disc.outer_sides().size() == 5 * 6 - 2 * 8);
    CHECK(dofs_of(disc).n_dofs == 16);
}

TEST_CASE("find_interfaces: six wedges around an edge", "[topology]") {
    // Each wedge has a collapsed side on the axis.
    MultiPatch<3> wedges;
    for (int i = 0; i < 6; ++i) {
        const auto rim = [](int j) {
            const double angle = std::numbers::pi * j / 3.0;
            return Vector2(std::cos(angle), std::sin(angle));
        };
        wedges.patches.push_back(
            bilinear_column({Vector2::Zero(), rim(i), Vector2::Zero(), rim(i + 1)}));
    }
    CHECK(find_interfaces(wedges).empty());
    CHECK(wedges.interfaces.size() == 6);
    CHECK(dofs_of(wedges).n_dofs == 2 * 7);
    CHECK(collapsed_entities(wedges).size() == 6);
}

TEST_CASE("find_interfaces: six cubes around an edge share it", "[topology]") {
    MultiPatch<3> star;
    for (int i = 0; i < 6; ++i) {
        const auto rim = [](int j, double radius) {
            const double angle = std::numbers::pi * j / 6.0;
            return Vector2(radius * std::cos(angle), radius * std::sin(angle));
        };
        star.patches.push_back(bilinear_column(
            {Vector2::Zero(), rim(2 * i, 1), rim(2 * i + 2, 1), rim(2 * i + 1, 2)}));
    }
    CHECK(find_interfaces(star).empty());
    CHECK(star.interfaces.size() == 6);
    CHECK(dofs_of(star).n_dofs == 2 * 13);
}

TEST_CASE("find_interfaces: a ring of one patch meets itself", "[topology]") {
    MultiPatch<2> ring{{sector(1, 2, 0, 2 * std::numbers::pi, 4)}, {}, {}};
    CHECK(find_interfaces(ring).empty());
    REQUIRE(ring.interfaces.size() == 1);
    CHECK(ring.interfaces[0] == Interface<2>{0, 2, 0, 3, SideMap<2>::identity()});
    check(ring);
    CHECK(dofs_of(ring).n_dofs == 2 * 8);
    CHECK(volume(ring) == Approx(3 * std::numbers::pi).epsilon(1e-13));
    // Refined, it still closes.
    const MultiPatch<2> fine = refine<2>(ring, 3, std::array{2, 8});
    check(fine, 1e-14);
    CHECK(volume(fine) == Approx(3 * std::numbers::pi).epsilon(1e-13));
}

TEST_CASE("find_interfaces: a torus of one patch meets itself twice", "[topology]") {
    const KnotVector around = KnotVector::uniform(1, 8);
    const KnotVector along = KnotVector::uniform(1, 12);
    MultiPatch<2> torus{{make_mapped_patch<2>({{around, along}},
                                              [](const Vector2& xi) {
                                                  const Vector2 angle = 2 * std::numbers::pi * xi;
                                                  const double r = 3.0 + std::cos(angle[0]);
                                                  return VectorX(Vector3(r * std::cos(angle[1]),
                                                                         r * std::sin(angle[1]),
                                                                         std::sin(angle[0])));
                                              })},
                        {},
                        {}};
    CHECK(find_interfaces(torus).empty());
    CHECK(torus.interfaces.size() == 2);
    CHECK(torus.outer_sides().empty());
    CHECK(dofs_of(torus).n_dofs == 8 * 12);
}

TEST_CASE("find_interfaces: a Moebius band refines to knots that read the same both ways",
          "[topology]") {
    const KnotVector across(1, {0, 0, 0.25, 1, 1});
    MultiPatch<2> band{
        {make_mapped_patch<2>({{across, KnotVector::uniform(1, 16)}},
                              [](const Vector2& xi) {
                                  const double angle = 2 * std::numbers::pi * xi[1];
                                  const double s = xi[0] - 0.5;
                                  const double r = 3.0 + s * std::cos(angle / 2);
                                  return VectorX(Vector3(r * std::cos(angle), r * std::sin(angle),
                                                         s * std::sin(angle / 2)));
                              })},
        {},
        {}};
    CHECK(find_interfaces(band).empty());
    REQUIRE(band.interfaces.size() == 1);
    CHECK(band.interfaces[0].map.reversed[0]);
    CHECK(band.patches[0].knots(0).breakpoints() == std::vector<double>{0, 0.25, 0.75, 1});
    check(band);
}

TEST_CASE("find_interfaces: collapsed sides never match", "[topology]") {
    // Two triangles tip to tip, and the tip's sides are points.
    const KnotVector knots = KnotVector::uniform(1, 1);
    MatrixX left(4, 2);
    left << -1, 0, 0, 0, -1, 1, 0, 0;
    MatrixX right(4, 2);
    right << 0, 0, 1, 0, 0, 0, 1, 1;
    MultiPatch<2> tips{
        {Patch<2>({{knots, knots}}, left), Patch<2>({{knots, knots}}, right)}, {}, {}};
    CHECK(find_interfaces(tips).empty());
    CHECK(tips.interfaces.empty());
    CHECK(dofs_of(tips).n_dofs == 6);
}

TEST_CASE("find_interfaces: other knots and degrees are refined through all neighbours",
          "[topology]") {
    const KnotVector coarse = KnotVector::uniform(1, 1);
    const KnotVector thirds = KnotVector::uniform(2, 3);
    const auto box = [](const KnotVector& a, const KnotVector& b, double offset) {
        return make_mapped_patch<2>(
            {{a, b}}, [&](const Vector2& xi) { return VectorX(xi + Vector2(offset, 0.0)); });
    };
    MultiPatch<2> row{
        {box(coarse, coarse, 0.0), box(coarse, coarse, 1.0),
         reoriented<2>(box(coarse, thirds, 2.0), {1, 0}, {true, false}),
         box(KnotVector(1, {0, 0, 0.5, 1, 1}), KnotVector(1, {0, 0, 0.1, 1, 1}), 3.0)},
        {},
        {}};
    CHECK(find_interfaces(row).empty());
    CHECK(row.interfaces.size() == 3);
    check(row, 1e-14);
    // Degree 2; thirds stay simple, 0.1 was of continuity 0.
    const std::vector<int> multiplicities{3, 2, 1, 1, 3};
    for (const int p : {0, 1, 3}) {
        CHECK(row.patches[p].knots(1).degree() == 2);
        CHECK(row.patches[p].knots(1).multiplicities() == multiplicities);
        CHECK(row.patches[p].knots(0).degree() == 1);
    }
    CHECK(row.patches[2].knots(0).multiplicities() == std::vector<int>{3, 1, 1, 2, 3});
    CHECK(row.patches[3].knots(0).n_elements() == 2);
    CHECK(volume(row) == Approx(4.0).epsilon(1e-14));
}

TEST_CASE("find_interfaces: knots that differ by rounding make no slivers", "[topology]") {
    constexpr double printed = 3e-11;  // knots printed with ten digits
    const auto box = [](const KnotVector& b, double offset) {
        return make_mapped_patch<2>({{KnotVector::uniform(1, 1), b}}, [&](const Vector2& xi) {
            return VectorX(xi + Vector2(offset, 0.0));
        });
    };
    MultiPatch<2> row{{box(KnotVector(1, {0, 0, 0.3, 1, 1}), 0.0),
                       box(KnotVector(1, {0, 0, 0.3 + printed, 1, 1}), 1.0),
                       box(KnotVector(1, {0, 0, 0.3 - printed, 0.7, 1, 1}), 2.0)},
                      {},
                      {}};
    CHECK(find_interfaces(row).empty());
    CHECK(row.interfaces.size() == 2);
    for (const Patch<2>& patch : row.patches) {
        CHECK(patch.knots(1).n_elements() == 3);
    }
    check(row);
}

TEST_CASE("find_interfaces: weights agree up to a factor, and not otherwise", "[topology]") {
    const Patch<2> inner = sector(1, 2, 0, 1, 1);
    Patch<2> outer = sector(2, 3, 0, 1, 1);
    outer = Patch<2>(outer.space(), outer.control_points(), 2.5 * outer.weights());
    MultiPatch<2> good{{inner, outer}, {}, {}};
    CHECK(find_interfaces(good).empty());
    CHECK(good.interfaces.size() == 1);

    VectorX weights = outer.weights();
    weights[2] *= 1.1;
    MultiPatch<2> bad{{inner, Patch<2>(outer.space(), outer.control_points(), weights)}, {}, {}};
    const std::vector<std::string> warnings = find_interfaces(bad);
    REQUIRE(warnings.size() == 1);
    CHECK_THAT(warnings[0], Catch::Contains("patch 0 side 0:high and patch 1 side 0:low have the "
                                            "same control points but their weights differ by"));
    CHECK(bad.interfaces.empty());
}

TEST_CASE("find_interfaces: same corners and other shapes are reported with the gap",
          "[topology]") {
    const KnotVector quadratic = KnotVector::uniform(2, 1);
    const auto box = [&](double bump, double offset) {
        Patch<2> patch = make_mapped_patch<2>({{quadratic, quadratic}}, [&](const Vector2& xi) {
            return VectorX(xi + Vector2(offset, 0.0));
        });
        MatrixX points = patch.control_points();
        points(offset == 0.0 ? 5 : 3, 0) += bump;
        return Patch<2>(patch.space(), points);
    };
    MultiPatch<2> pair{{box(0.0, 0.0), box(0.125, 1.0)}, {}, {}};
    const std::vector<std::string> warnings = find_interfaces(pair);
    REQUIRE(warnings.size() == 1);
    CHECK_THAT(warnings[0],
               Catch::Contains("patch 0 side 0:high and patch 1 side 0:low have the same corners "
                               "but their shapes or parametrisations differ: largest gap 0.125"));
    CHECK(pair.interfaces.empty());
    // The rims of a hole cut in two share corners, and are not meant to be one.
    MultiPatch<2> halves{
        {sector(1, 2, 0, std::numbers::pi, 2), sector(1, 2, std::numbers::pi, std::numbers::pi, 2)},
        {},
        {}};
    CHECK(find_interfaces(halves).empty());
    CHECK(halves.interfaces.size() == 2);
}

TEST_CASE("find_interfaces: three sides in one place are an error", "[topology]") {
    MultiPatch<2> three{{make_unit_box<2>(1, 1), make_unit_box<2>(1, 1, {1.0, 0.0}),
                         reoriented<2>(make_unit_box<2>(1, 1, {1.0, 0.0}), {0, 1}, {true, false})},
                        {},
                        {}};
    CHECK_THROWS_WITH(find_interfaces(three),
                      Catch::Contains("coincide; at most two sides may meet"));
    CHECK_THROWS_AS(find_interfaces(three), TopologyError);
    MultiPatch<2> box{{make_unit_box<2>(1, 1)}, {}, {}};
    CHECK_THROWS_WITH(find_interfaces(box, 0.0),
                      "find_interfaces: tolerance = 0; must be positive");
}

TEST_CASE("find_interfaces: given interfaces stay and are not found again", "[topology]") {
    MultiPatch<2> row{{make_unit_box<2>(1, 1), make_unit_box<2>(1, 1, {1.0, 0.0}),
                       make_unit_box<2>(1, 1, {2.0, 0.0})},
                      {{1, 0, 0, 1, SideMap<2>::identity()}},
                      {}};
    CHECK(find_interfaces(row).empty());
    CHECK(row.interfaces.size() == 2);
    CHECK(find_interfaces(row).empty());
    CHECK(row.interfaces.size() == 2);
}

TEST_CASE("make_conforming: shapes that differ are named with the gap", "[topology]") {
    MultiPatch<2> pair{{make_unit_box<2>(1, 1), make_unit_box<2>(2, 3, {1.25, 0.0})},
                       {{0, 1, 1, 0, SideMap<2>::identity()}},
                       {}};
    CHECK_THROWS_WITH(make_conforming(pair),
                      Catch::Contains("make_conforming: patch 0 side 0:high and patch 1 side 0:low "
                                      "are an interface but their shapes differ: largest gap "
                                      "0.25"));
    CHECK_THROWS_AS(make_conforming(pair), TopologyError);
}

TEST_CASE("find_interfaces: a patch that lies on another is refused", "[topology]") {
    MultiPatch<3> twice{{make_unit_box<3>(1, 1), make_unit_box<3>(1, 1)}, {}, {}};
    CHECK_THROWS_WITH(find_interfaces(twice),
                      "find_interfaces: all sides of patch 0 coincide with those of patch 1: one "
                      "lies on the other; remove it");
}

TEST_CASE("find_interfaces: 8000 patches take less than two seconds", "[topology]") {
    constexpr int n = 20;
    MultiPatch<3> grid;
    grid.patches.reserve(n * n * n);
    for (int i = 0; i < n * n * n; ++i) {
        grid.patches.push_back(
            make_unit_box<3>(1, 1, Vector3(i % n, (i / n) % n, static_cast<double>(i / (n * n)))));
    }
    const Timer timer;
    CHECK(find_interfaces(grid).empty());
    CHECK(timer.seconds() < 2.0);
    CHECK(grid.interfaces.size() == 3 * n * n * (n - 1));
    CHECK(dofs_of(grid).n_dofs == (n + 1) * (n + 1) * (n + 1));
    check(grid);
}
