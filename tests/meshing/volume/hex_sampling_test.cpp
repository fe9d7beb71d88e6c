#include "meshing/volume/hex_sampling.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "iga/core/error.h"
#include "iga/spline/shapes.h"
#include "iga/topology/side_patch.h"
#include "meshing/parts/parts.h"
#include "tests/meshing/volume/volume_samples.h"

namespace couture::meshing {

namespace {

using Catch::Matchers::Contains;
using iga::MultiPatch;

constexpr double exactly = 1e-12;

/// Points of sides 0 to 5 of a patch of degree 1.
std::array<MatrixX, 6> grids_of(const iga::Volume& patch) {
    std::array<MatrixX, 6> sides;
    for (int side = 0; side < 6; ++side) {
        sides[side] = iga::entity_patch<3, 2>(patch, iga::make_side<3>(0, side).position)
                          .control_points()
                          .transpose();
    }
    return sides;
}

}  // namespace

TEST_CASE("sample_hexahedra: as many points as control points, uniform in the parameter",
          "[volume]") {
    // Eq. (7.1): 8 control points on 6 elements.
    const MultiPatch<3> cube = cube_of(2, 6);
    const SampledHexahedra result = sample_hexahedra(cube);
    REQUIRE(result.hexahedra.n_patches() == 1);
    const iga::Volume& grid = result.hexahedra.patches[0];
    for (int k = 0; k < 3; ++k) CHECK(grid.knots(k).n_basis() == 8);
    for (int i = 0; i < grid.space().n_basis(); ++i) {
        const auto at = grid.space().indices(i);
        const Vector3 expected = Vector3(at[0], at[1], at[2]) / 7.0;
        CHECK((grid.control_points().row(i).transpose() - expected).norm() < exactly);
    }
    CHECK(result.report.validity == iga::Validity::valid);
    CHECK_FALSE(result.has_moved_points);
}

TEST_CASE("sample_hexahedra: all parts, conforming and positive, on the body", "[volume]") {
    for (const PartInfo& info : parts()) {
        if (info.dimension != 3) continue;
        const auto part = std::get<MultiPatch<3>>(make_part(info.name));
        const SampledHexahedra result = sample_hexahedra(part, 6);
        CAPTURE(info.name);
        CHECK(result.report.validity == iga::Validity::valid);
        CHECK_NOTHROW(iga::check(result.hexahedra, exactly));
        CHECK(result.hexahedra.interfaces == part.interfaces);
        CHECK(result.hexahedra.boundary_sets == part.boundary_sets);
        CHECK_FALSE(result.has_moved_points);
        const auto& space = result.hexahedra.patches[0].space();
        const iga::Volume& patch = part.patches[0];
        const Vector3 middle =
            result.hexahedra.patches[0].control_points().row(space.index({2, 3, 1}));
        Vector3 xi;
        for (int k = 0; k < 3; ++k) {
            const double part_of_interval = std::array<double, 3>{0.4, 0.6, 0.2}[k];
            xi[k] = patch.knots(k).front() +
                    part_of_interval * (patch.knots(k).back() - patch.knots(k).front());
        }
        CHECK((middle - patch.point(xi)).norm() < exactly * part.size());
    }
    // Two points don't go round a ring.
    const auto ring = iga::make_revolution(
        iga::make_multilinear<2>(MatrixX{{1.0, 0.0}, {1.0, 1.0}, {2.0, 0.0}, {2.0, 1.0}}), 4.5);
    const MultiPatch<3> open{{ring}, {}, {}};
    CHECK(sample_hexahedra(open, 9).report.validity == iga::Validity::valid);
    CHECK(sample_hexahedra(open, 2).report.validity == iga::Validity::folded);
    CHECK_THROWS_WITH(sample_hexahedra(cube_of(1, 1), 1), Contains("1 points per direction"));
}

TEST_CASE("hexahedra_between: boxes are reproduced, curved sides stay", "[volume]") {
    const auto box = sample_hexahedra(cube_of(2, 3), 6).hexahedra.patches[0];
    const SampledHexahedra again = hexahedra_between(grids_of(box), {6, 6, 6});
    CHECK((again.hexahedra.patches[0].control_points() - box.control_points()).norm() < exactly);

    const auto bent = std::get<MultiPatch<3>>(make_part("thick_cylinder_3d"));
    const auto grid = sample_hexahedra(bent, 7).hexahedra.patches[0];
    const SampledHexahedra filled = hexahedra_between(grids_of(grid), {7, 7, 7});
    CHECK(filled.report.validity == iga::Validity::valid);
    const MatrixX& points = filled.hexahedra.patches[0].control_points();
    const auto& space = filled.hexahedra.patches[0].space();
    for (int i = 0; i < space.n_basis(); ++i) {
        const auto at = space.indices(i);
        bool is_inner = true;
        Vector3 mean = Vector3::Zero();
        for (int k = 0; k < 3; ++k) is_inner = is_inner && at[k] > 0 && at[k] < 6;
        if (!is_inner) {
            CHECK(points.row(i) == grid.control_points().row(i));
            continue;
        }
        for (int side = 0; side < 6; ++side) {
            auto next = at;
            next[side / 2] += side % 2 == 0 ? -1 : 1;
            mean += points.row(space.index(next)).transpose() / 6.0;
        }
        CHECK((points.row(i).transpose() - mean).norm() < exactly);
    }
}

TEST_CASE("hexahedra_between: Coons where the Laplacian folds, wrong grids refused", "[volume]") {
    // Most of a ring: the middle of neighbours lies in its hole.
    auto grid = sample_hexahedra(cube_of(1, 1), 9).hexahedra.patches[0];
    MatrixX points = grid.control_points();
    for (int i = 0; i < points.rows(); ++i) {
        const double r = 1.0 + points(i, 0);
        const double angle = 5.0 * points(i, 1);
        points.row(i) = Vector3(r * std::cos(angle), r * std::sin(angle), points(i, 2));
    }
    grid = iga::Volume(grid.space(), points);
    std::array<MatrixX, 6> sides = grids_of(grid);
    const SampledHexahedra filled = hexahedra_between(sides, {9, 9, 9});
    CHECK(filled.report.validity == iga::Validity::valid);
    CHECK_FALSE(filled.has_moved_points);

    CHECK_THROWS_WITH(hexahedra_between(sides, {9, 9, 8}), Contains("side 0 has 81 points"));
    CHECK_THROWS_WITH(hexahedra_between(sides, {1, 9, 9}), Contains("1 points in direction 0"));
    sides[2](0, 0) += 0.1;
    CHECK_THROWS_WITH(hexahedra_between(sides, {9, 9, 9}), Contains("sides must meet"));
}

}  // namespace couture::meshing
