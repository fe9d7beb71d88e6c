#include "meshing/topology/integer_lattice.h"

#include <catch2/catch.hpp>

using namespace couture::meshing;

TEST_CASE("integer lattice: determinants", "[meshing][topology]") {
    REQUIRE(determinant({}) == 1);
    REQUIRE(determinant({{-7}}) == -7);
    REQUIRE(determinant({{0, 1}, {1, 0}}) == -1);
    REQUIRE(determinant({{2, 3, 1}, {4, 1, 5}, {6, 2, 7}}) ==
            -2 * 0 + 2 * (7 - 10) - 3 * (28 - 30) + (8 - 6));
    REQUIRE(determinant({{1, 2}, {2, 4}}) == 0);
}

TEST_CASE("integer lattice: elementary divisors and primitive rows", "[meshing][topology]") {
    REQUIRE(elementary_divisors({{2, 4}, {6, 8}}) == std::vector<long long>{2, 4});
    REQUIRE(elementary_divisors({{0, 0}, {0, 0}}).empty());
    REQUIRE(is_primitive({{2, 3, 0}}));
    REQUIRE_FALSE(is_primitive({{2, 4, 0}}));
    // Each row is primitive, both together are not.
    REQUIRE_FALSE(is_primitive({{1, 1, 0}, {1, -1, 0}}));
    REQUIRE_FALSE(is_primitive({{1, 2, 0}, {2, 4, 0}}));
}

TEST_CASE("integer lattice: the left kernel is what a matrix sends to 0", "[meshing][topology]") {
    const IntegerMatrix matrix{{1, 2, 3}, {2, 4, 6}, {0, 1, 1}, {1, 3, 4}};
    const IntegerMatrix kernel = left_kernel(matrix);
    REQUIRE(kernel.size() == 2);
    REQUIRE(is_primitive(kernel));
    for (const auto& row : multiply(kernel, matrix)) {
        for (const long long x : row) REQUIRE(x == 0);
    }
}
