#include "iga/core/disjoint_sets.h"

#include <catch2/catch.hpp>

using namespace couture;

TEST_CASE("DisjointSets: joined numbers share their smallest", "[core]") {
    DisjointSets sets(6);
    sets.join(5, 3);
    sets.join(3, 1);
    sets.join(0, 4);
    CHECK(sets.find(5) == 1);
    CHECK(sets.find(3) == 1);
    CHECK(sets.find(1) == 1);
    CHECK(sets.find(4) == 0);
    CHECK(sets.find(2) == 2);
    sets.join(4, 5);
    CHECK(sets.find(3) == 0);
    CHECK(sets.find(2) == 2);
}
