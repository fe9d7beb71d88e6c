#include "meshing/volume/boundary_features.h"

#include <catch2/catch.hpp>

#include "iga/core/error.h"
#include "tests/meshing/volume/volume_samples.h"

namespace couture::meshing {

namespace {

int count(const BoundaryFeatures& features, Freedom freedom) {
    int result = 0;
    for (int i = 0; i < features.dofs().n_dofs; ++i) {
        result += features.freedom(i) == freedom ? 1 : 0;
    }
    return result;
}

}  // namespace

TEST_CASE("BoundaryFeatures: a cube has 6 faces, 12 curves, 8 corners", "[volume]") {
    for (const int degree : {1, 2, 3}) {
        // With n control points per direction.
        const int n = degree + 3;
        const BoundaryFeatures features(cube_of(degree, 3));
        CHECK(features.faces().size() == 6);
        CHECK(features.curves().size() == 12);
        CHECK(features.corners().size() == 8);
        CHECK(count(features, Freedom::fixed) == 8);
        CHECK(count(features, Freedom::curve) == 12 * (n - 2));
        CHECK(count(features, Freedom::face) == 6 * (n - 2) * (n - 2));
        CHECK(count(features, Freedom::interior) == (n - 2) * (n - 2) * (n - 2));
    }
}

TEST_CASE("BoundaryFeatures: faces and curves run on through smooth joints", "[volume]") {
    const iga::MultiPatch<3> cube = two_patch_cube(1, 4);
    const BoundaryFeatures features(cube);
    CHECK(features.faces().size() == 6);
    CHECK(features.curves().size() == 12);
    CHECK(features.corners().size() == 8);

    SECTION("unless sides belong to different sets") {
        iga::MultiPatch<3> named = cube;
        named.boundary_sets["low_half_of_bottom"] = {iga::make_side<3>(0, 4)};
        const BoundaryFeatures with_set(named);
        CHECK(with_set.faces().size() == 7);
        // The new curve across the bottom, and two bottom edges cut by its ends.
        CHECK(with_set.curves().size() == 15);
        CHECK(with_set.corners().size() == 10);
    }
    SECTION("an inner side of a set is a face, and a feature where it reaches the surface") {
        iga::MultiPatch<3> named = cube;
        named.boundary_sets["middle"] = {iga::make_side<3>(0, 1)};
        const BoundaryFeatures with_set(named);
        CHECK(with_set.faces().size() == 11);
        CHECK(with_set.curves().size() == 20);
        CHECK(with_set.corners().size() == 12);
    }
    SECTION("a named edge slides, a named inner edge and corner stay") {
        iga::MultiPatch<3> named = cube_of(2, 3);
        iga::PatchEntity<3> corner{0, {iga::End::low, iga::End::low, iga::End::low}};
        named.boundary_sets["edge"] = {{0, {iga::End::low, iga::End::low, iga::End::free}}};
        named.boundary_sets["corner"] = {corner};
        const BoundaryFeatures with_set(named);
        CHECK(count(with_set, Freedom::fixed) == 8);
        CHECK(with_set.curves().size() == 12);
    }
}

TEST_CASE("BoundaryFeatures: the rims of a cylinder are closed curves", "[volume]") {
    for (const int degree : {1, 2}) {
        const BoundaryFeatures features(part_of("cylinder_o_grid", degree, 4));
        CHECK(features.faces().size() == 3);
        CHECK(features.curves().size() == 2);
        CHECK(features.corners().empty());
    }
}

TEST_CASE("BoundaryFeatures: a smaller angle finds more edges", "[volume]") {
    // Four elements to a quarter: 22.5 degrees between them, halved at the seams of patches.
    const iga::MultiPatch<3> part = part_of("cylinder_o_grid", 1, 4);
    CHECK(BoundaryFeatures(part, 0.3).faces().size() > BoundaryFeatures(part, 0.5).faces().size());
}

TEST_CASE("BoundaryFeatures: errors", "[volume]") {
    CHECK_THROWS_AS(BoundaryFeatures(cube_of(1, 2), 0.0), InputError);
    CHECK_THROWS_WITH(BoundaryFeatures(cube_of(1, 2), 4.0),
                      "BoundaryFeatures: feature angle 4 is out of range; it must lie in (0, pi)");
}

}  // namespace couture::meshing
