#include "iga/spline/knot_vector.h"

#include <catch2/catch.hpp>

#include "iga/core/error.h"

using namespace couture;
using namespace couture::iga;

TEST_CASE("KnotVector: elements, spans and multiplicities follow from the knots", "[spline]") {
    const KnotVector knots(2, {0, 0, 0, 0.25, 0.5, 0.5, 1, 1, 1});
    CHECK(knots.n_basis() == 6);
    CHECK(knots.n_elements() == 3);
    CHECK(knots.breakpoints() == std::vector<double>{0, 0.25, 0.5, 1});
    CHECK(knots.multiplicities() == std::vector<int>{3, 1, 2, 3});
    CHECK(knots.find_span(0.5) == 5);
    CHECK(knots.find_element(1.0) == 2);
}

TEST_CASE("KnotVector: broken rules are named with their values", "[spline]") {
    CHECK_THROWS_WITH(KnotVector(2, {0, 0, 0, 0.5, 0.25, 1, 1, 1}),
                      "KnotVector: knot 4 = 0.25 is smaller than knot 3 = 0.5; knots must not "
                      "decrease");
    CHECK_THROWS_WITH(KnotVector(9, {0, 1}), "KnotVector: degree = 9; must be from 1 to 8");
    CHECK_THROWS_AS(KnotVector(1, {0, 1, 2, 3}), InputError);
}
