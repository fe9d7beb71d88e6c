#include "iga/core/nearest_name.h"

#include <catch2/catch.hpp>

using namespace couture;

TEST_CASE("edit_distance: counts insertions, deletions and replacements", "[core]") {
    CHECK(edit_distance("", "") == 0);
    CHECK(edit_distance("", "abc") == 3);
    CHECK(edit_distance("kitten", "sitting") == 3);
    CHECK(edit_distance("sitting", "kitten") == 3);
    CHECK(edit_distance("Inner", "inner") == 0);
}

TEST_CASE("nearest_name: the first of the nearest candidates", "[core]") {
    CHECK(nearest_name("youngs_modul", {"density", "youngs_modulus"}) == "youngs_modulus");
    CHECK(nearest_name("b", {"aa", "c", "d"}) == "c");
    CHECK_FALSE(nearest_name("b", {}));
}
