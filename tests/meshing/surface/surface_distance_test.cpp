#include "meshing/surface/surface_distance.h"

#include <catch2/catch.hpp>

#include "iga/core/error.h"
#include "meshing/surface/triangle_tree.h"

using namespace couture;
using namespace couture::meshing;

TEST_CASE("triangle tree: segments as triangles", "[surface]") {
    // Lengths that are no sums of powers of two, so that cross products are not exactly zero.
    std::vector<SpaceTriangle> segments;
    Vector3 before(-20.0, -20.0, -20.0);
    for (int k = 1; k <= 24; ++k) {
        const Vector3 x(-20.0 + 40.0 * k / 24.0 + 1e-15 * k, -20.0 + 3e-15 * k, -20.0 - 2e-15 * k);
        segments.push_back({before, x, x});
        before = x;
    }
    const TriangleTree tree(segments);
    for (int k = 0; k <= 1000; ++k) {
        const Vector3 x(-20.0 + 40.0 * k / 1000.0, -20.0, -20.0);
        CHECK(tree.nearest(x).squared_distance < 1e-24);
    }
}

TEST_CASE("hausdorff distance: two squares", "[surface]") {
    const auto square = [](double size, double height) {
        const Vector3 a(0, 0, height);
        const Vector3 b(size, 0, height);
        const Vector3 c(size, size, height);
        const Vector3 d(0, size, height);
        return std::vector<SpaceTriangle>{{a, b, c}, {a, c, d}};
    };
    CHECK(hausdorff_distance(square(1.0, 0.0), square(1.0, 0.25)) == Approx(0.25));
    // The larger one has a corner that is far from the smaller one, not the other way round.
    CHECK(hausdorff_distance(square(1.0, 0.0), square(2.0, 0.0)) == Approx(std::sqrt(2.0)));
    CHECK(hausdorff_distance(square(2.0, 0.0), square(1.0, 0.0)) == Approx(std::sqrt(2.0)));
    CHECK_THROWS_AS(hausdorff_distance({}, square(1.0, 0.0)), InputError);
}
