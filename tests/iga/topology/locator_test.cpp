#include "iga/topology/locator.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "iga/core/error.h"
#include "iga/spline/shapes.h"
#include "tests/iga/topology/test_patches.h"

using namespace couture;
using namespace couture::iga;

namespace {

/// Of a body of size one.
constexpr double found_exactly = 1e-12;

/// A box, a left-handed box and a quarter ring's slab in a row along x.
MultiPatch<3> three_bodies() {
    MultiPatch<3> part;
    part.patches = {
        make_unit_box<3>(2, 2),
        reoriented<3>(make_unit_box<3>(1, 3, Vector3(1, 0, 0)), {1, 0, 2}, {false, true, true}),
        make_extrusion(make_quarter_annulus(3.0, 4.0), Vector3(0, 0, 1))};
    return part;
}

}  // namespace

TEST_CASE("Locator: points inside are found in their patch", "[post]") {
    const MultiPatch<3> part = three_bodies();
    const Locator<3> locator(part);
    for (int patch = 0; patch < part.n_patches(); ++patch) {
        for (const double t : {0.02, 0.41, 0.5, 0.87}) {
            const Vector3 xi(t, std::fmod(t + 0.3, 1.0), std::fmod(t + 0.6, 1.0));
            const Vector3 point = part.patches[patch].point(xi);
            const auto location = locator.find(point, found_exactly);
            REQUIRE(location);
            CHECK(location->patch == patch);
            CHECK((location->xi - xi).norm() < 10.0 * found_exactly);
        }
    }
}

TEST_CASE("Locator: sides, edges and corners belong to the body", "[post]") {
    const MultiPatch<3> part = three_bodies();
    const Locator<3> locator(part);
    for (const Vector3& point : {Vector3(1.0, 0.3, 0.7), Vector3(0, 0, 0), Vector3(2, 1, 1),
                                 Vector3(1, 1, 0.2), Vector3(0, 4, 0.5)}) {
        const auto location = locator.find(point, found_exactly);
        REQUIRE(location);
        const VectorX found = part.patches[location->patch].point(location->xi);
        CHECK((found - point).norm() < found_exactly);
    }
}

TEST_CASE("Locator: points outside are not found, but the nearest place is", "[post]") {
    const MultiPatch<3> part = three_bodies();
    const Locator<3> locator(part);
    // In the gap between the boxes and the ring; nearer to the ring.
    const Vector3 between(2.7, 0.0, 0.5);
    CHECK_FALSE(locator.find(between, found_exactly));
    const auto [location, distance] = locator.nearest(between);
    CHECK(location.patch == 2);
    CHECK(distance == Approx(0.3).epsilon(1e-9));
    CHECK((part.patches[2].point(location.xi) - Vector3(3.0, 0.0, 0.5)).norm() < 1e-9);
    // The tolerance is a distance.
    CHECK(locator.find(between, 0.301));
    CHECK_FALSE(locator.find(between, 0.299));
    CHECK(locator.nearest(Vector3(-3.0, -4.0, 0.5)).second == Approx(5.0).epsilon(1e-9));
    CHECK(locator.nearest(Vector3(0.0, 0.0, -7.0)).first.patch == 0);
}

TEST_CASE("Locator: plane parts and surfaces in space", "[post]") {
    MultiPatch<2> plane;
    plane.patches = {make_quarter_annulus(1.0, 2.0)};
    const Locator<2> in_plane(plane);
    const auto location = in_plane.find(Vector3(0.9, 1.2, 0.0), found_exactly);
    REQUIRE(location);
    CHECK(location->xi[0] == Approx(0.5));
    // A plane part knows no third coordinate.
    CHECK(in_plane.find(Vector3(0.9, 1.2, 5.0), found_exactly));

    MatrixX corners(4, 3);
    corners << 0, 0, 1, 1, 0, 1, 0, 1, 1, 1, 1, 2;
    MultiPatch<2> shell;
    shell.patches = {make_multilinear<2>(corners)};
    const Locator<2> in_space(shell);
    REQUIRE(in_space.find(Vector3(0.5, 0.5, 1.25), found_exactly));
    CHECK_FALSE(in_space.find(Vector3(0.5, 0.5, 0.0), found_exactly));
    CHECK(in_space.nearest(Vector3(0.0, 0.0, 0.0)).second == Approx(1.0));
}

TEST_CASE("Locator: a point that is not finite is refused", "[post]") {
    const Locator<3> locator(three_bodies());
    CHECK_THROWS_AS(locator.nearest(Vector3(0.0, std::numeric_limits<double>::quiet_NaN(), 0.0)),
                    InputError);
}
