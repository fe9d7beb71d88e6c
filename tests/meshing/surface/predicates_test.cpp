#include "meshing/surface/predicates.h"

#include <catch2/catch.hpp>
#include <cmath>

using namespace couture;
using namespace couture::meshing;

TEST_CASE("orientation: left is 1, right is -1, on the line is 0", "[meshing][surface]") {
    const Vector2 a(0.0, 0.0);
    const Vector2 b(2.0, 1.0);
    CHECK(orientation(a, b, Vector2(0.0, 1.0)) == 1);
    CHECK(orientation(a, b, Vector2(1.0, 0.0)) == -1);
    CHECK(orientation(a, b, Vector2(4.0, 2.0)) == 0);
}

TEST_CASE("orientation: exact and antisymmetric where rounding hides the sign",
          "[meshing][surface]") {
    // Points around (0.5, 0.5) by single steps of the last digit, against the diagonal: left of it
    // where y > x, whatever a rounded determinant says.
    const Vector2 b(12.0, 12.0);
    const Vector2 c(24.0, 24.0);
    const double step = std::ldexp(1.0, -53);
    int n_rounded_wrong = 0;
    for (int i = 0; i < 32; ++i) {
        for (int j = 0; j < 32; ++j) {
            const Vector2 p(0.5 + i * step, 0.5 + j * step);
            const int expected = (p.y() > p.x()) - (p.y() < p.x());
            REQUIRE(orientation(b, c, p) == expected);
            REQUIRE(orientation(c, b, p) == -expected);
            REQUIRE(orientation(c, p, b) == expected);
            const double rounded = (b - p).x() * (c - p).y() - (b - p).y() * (c - p).x();
            n_rounded_wrong += (rounded > 0.0) - (rounded < 0.0) != expected;
        }
    }
    CHECK(n_rounded_wrong > 0);
}

TEST_CASE("orientation: in space it is the sign of the volume", "[meshing][surface]") {
    const Vector3 o(0.0, 0.0, 0.0);
    const Vector3 x(1.0, 0.0, 0.0);
    const Vector3 y(0.0, 1.0, 0.0);
    const Vector3 z(0.0, 0.0, 1.0);
    CHECK(orientation(o, x, y, z) == 1);
    CHECK(orientation(o, y, x, z) == -1);
    CHECK(orientation(o, x, y, Vector3(0.3, 0.4, 0.0)) == 0);
    // The smallest number above the plane counts.
    CHECK(orientation(o, x, y, Vector3(0.3, 0.4, 5e-324)) == 1);
    CHECK(orientation(o, x, y, Vector3(0.3, 0.4, -5e-324)) == -1);
}
