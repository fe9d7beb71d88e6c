#include "verification/problem_tools.h"

#include <catch2/catch.hpp>

#include "iga/core/error.h"

using namespace couture;
using namespace couture::iga;
using namespace couture::verification;

TEST_CASE("make_space: any degree on any part, as smooth as the geometry allows",
          "[verification]") {
    const int degree = GENERATE(1, 2, 3, 5);
    const MultiPatch<3> box = part<3>("twisted_box");
    const SpacePtr<3> space = make_space<3>(box, degree, {3, 2, 4});
    for (int k = 0; k < 3; ++k) {
        CHECK(space->tensor(0).knots[k].degree() == degree);
    }
    CHECK(space->n_dofs() == (degree + 3) * (degree + 2) * (degree + 4));
}

TEST_CASE("probes outside the body are named", "[verification]") {
    const MultiPatch<2> ring = part<2>("quarter_annulus");
    const SpacePtr<2> space = make_space<2>(ring, 2, 1);
    const Field<2> zero{space, MatrixX::Zero(space->n_dofs(), 2)};
    CHECK(displacement_at<2>(zero, {1.5, 0.0, 0.0}).norm() == 0.0);
    CHECK_THROWS_WITH(displacement_at<2>(zero, {0.5, 0.0, 0.0}),
                      "probe (0.5, 0, 0) lies outside the body");
}

TEST_CASE("geometry_error: zero on the true surface, the gap on another", "[verification]") {
    const MultiPatch<2> ring = part<2>("quarter_annulus");
    CHECK(geometry_error<2>(ring, "outer", [](const Vector3& x) { return x.norm() - 2.0; }) <
          1e-14);
    CHECK(geometry_error<2>(ring, "outer", [](const Vector3& x) { return x.norm() - 1.9; }) ==
          Approx(0.1));
}
