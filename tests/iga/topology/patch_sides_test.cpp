#include "iga/topology/patch_sides.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <set>

#include "tests/iga/topology/test_patches.h"

using namespace couture;
using namespace couture::iga;

namespace {

TensorSpace<3> space_of_sizes(int a, int b, int c) {
    return {{KnotVector::uniform(1, a - 1), KnotVector::uniform(1, b - 1),
             KnotVector::uniform(1, c - 1)}};
}

}  // namespace

TEST_CASE("PatchEntity: dimension, side number and name follow from the position", "[topology]") {
    for (int side = 0; side < n_sides<3>; ++side) {
        const PatchEntity<3> entity = make_side<3>(4, side);
        CHECK(entity.is_side());
        CHECK(entity.side() == side);
    }
    CHECK(make_side<3>(3, 0).name() == "patch 3 side 0:low");
    CHECK(PatchEntity<3>{3, {End::low, End::free, End::high}}.name() ==
          "patch 3 edge 0:low 2:high");
    CHECK(PatchEntity<2>{1, {End::low, End::high}}.name() == "patch 1 corner 0:low 1:high");
}

TEST_CASE("entities_of_patch: a cube has 6 sides, 12 edges, 8 corners", "[topology]") {
    CHECK(entities_of_patch<3>(0, 2).size() == 6);
    CHECK(entities_of_patch<3>(0, 1).size() == 12);
    CHECK(entities_of_patch<3>(0, 0).size() == 8);
    CHECK(entities_of_patch<2>(0, 1).size() == 4);
    CHECK(entities_of_patch<2>(0, 0).size() == 4);
    for (int dimension = 0; dimension < 3; ++dimension) {
        const auto entities = entities_of_patch<3>(7, dimension);
        CHECK(std::set(entities.begin(), entities.end()).size() == entities.size());
        for (const PatchEntity<3>& entity : entities) {
            CHECK(entity.dimension() == dimension);
            CHECK(entity.patch == 7);
        }
    }
    for (int side = 0; side < 6; ++side) {
        CHECK(entities_of_patch<3>(0, 2)[side].side() == side);
    }
}

TEST_CASE("functions_on: the first free direction runs fastest", "[topology]") {
    const TensorSpace<3> space = space_of_sizes(2, 3, 4);
    CHECK(functions_on<3>(space, {End::high, End::free, End::free}) ==
          std::vector<int>{1, 3, 5, 7, 9, 11, 13, 15, 17, 19, 21, 23});
    CHECK(functions_on<3>(space, {End::free, End::high, End::low}) == std::vector<int>{4, 5});
    CHECK(functions_on<3>(space, {End::high, End::high, End::high}) == std::vector<int>{23});
}

TEST_CASE("tangential_directions: all but the side's own", "[topology]") {
    CHECK(tangential_directions<3>(0) == std::array{1, 2});
    CHECK(tangential_directions<3>(3) == std::array{0, 2});
    CHECK(tangential_directions<2>(2) == std::array{0});
}

TEST_CASE("SideMap: 8 different maps, each with its inverse", "[topology]") {
    const std::vector<SideMap<3>> maps = all_side_maps<3>();
    REQUIRE(maps.size() == 8);
    CHECK(all_side_maps<2>().size() == 2);
    CHECK(maps[0] == SideMap<3>::identity());
    for (std::size_t i = 0; i < maps.size(); ++i) {
        CHECK(maps[i].inverse().inverse() == maps[i]);
        for (std::size_t j = 0; j < i; ++j) {
            CHECK_FALSE(maps[i] == maps[j]);
        }
    }
}

TEST_CASE("matching_functions: there and back is the same function", "[topology]") {
    // Sizes of the second patch are such that the sides conform in each of the maps.
    for (int first_side = 0; first_side < 6; ++first_side) {
        for (int second_side = 0; second_side < 6; ++second_side) {
            for (const SideMap<3>& map : all_side_maps<3>()) {
                const TensorSpace<3> first = space_of_sizes(2, 3, 4);
                std::array<int, 3> sizes{5, 5, 5};
                for (int i = 0; i < 2; ++i) {
                    const int there = tangential_directions<3>(second_side)[map.axis[i]];
                    sizes[there] = first.sizes()[tangential_directions<3>(first_side)[i]];
                }
                const TensorSpace<3> second = space_of_sizes(sizes[0], sizes[1], sizes[2]);
                const Interface<3> interface { 0, first_side, 1, second_side, map };
                const Interface<3> back{1, second_side, 0, first_side, map.inverse()};
                REQUIRE_FALSE(nonconforming_direction(first, second, interface));
                REQUIRE_FALSE(nonconforming_direction(second, first, back));

                const auto here = functions_on<3>(first, make_side<3>(0, first_side).position);
                const auto there = functions_on<3>(second, make_side<3>(0, second_side).position);
                const std::vector<int> matching = matching_functions(second, interface);
                const std::vector<int> matching_back = matching_functions(first, back);
                REQUIRE(matching.size() == here.size());
                bool returns = true;
                for (std::size_t i = 0; i < here.size(); ++i) {
                    const auto at =
                        std::find(there.begin(), there.end(), matching[i]) - there.begin();
                    returns = returns && matching_back[at] == here[i];
                }
                CHECK(returns);
            }
        }
    }
}

TEST_CASE("nonconforming_direction: names the tangential direction of the first side",
          "[topology]") {
    const KnotVector a(1, {0, 0, 0.25, 1, 1});
    const KnotVector b = KnotVector::uniform(2, 2);
    const TensorSpace<3> first{{b, a, b}};
    const TensorSpace<3> same{{b, a, b.rescaled(-1, 5)}};
    CHECK_FALSE(nonconforming_direction<3>(first, same, {0, 1, 1, 0, {{0, 1}, {false, true}}}));
    CHECK(nonconforming_direction<3>(first, same, {0, 1, 1, 0, {{0, 1}, {true, false}}}) == 0);
    CHECK_FALSE(nonconforming_direction<3>(first, {{b, a.reversed(), b}},
                                           {0, 1, 1, 0, {{0, 1}, {true, false}}}));
    CHECK(nonconforming_direction<3>(first, {{b, a, a}}, {0, 1, 1, 0, {{0, 1}, {}}}) == 1);
    CHECK(to_string(Interface<3>{0, 1, 2, 4, {}}) == "patch 0 side 0:high and patch 2 side 2:low");
}
