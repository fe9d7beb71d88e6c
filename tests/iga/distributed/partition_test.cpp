#include "iga/distributed/partition.h"

#include <catch2/catch.hpp>

#include <map>

#include "iga/core/error.h"

namespace couture::iga {

namespace {

using Parts = std::vector<std::vector<ElementBox<3>>>;

/// Patches in a row along x, each a unit cube.
Vector3 middle_in_row(const ElementBox<3>& box, const std::vector<std::array<int, 3>>& n) {
    Vector3 x;
    for (int k = 0; k < 3; ++k) {
        x[k] = 0.5 * (box.first[k] + box.end[k]) / n[box.patch][k];
    }
    x[0] += box.patch;
    return x;
}

Parts parts_of_row(const std::vector<std::array<int, 3>>& n, int n_parts) {
    return partition<3>(
        n, [&](const ElementBox<3>& box) { return middle_in_row(box, n); }, n_parts);
}

/// How often each element occurs.
std::map<std::array<int, 4>, int> count_elements(const Parts& parts) {
    std::map<std::array<int, 4>, int> count;
    for (const auto& boxes : parts) {
        for (const ElementBox<3>& box : boxes) {
            for (int i = box.first[0]; i < box.end[0]; ++i) {
                for (int j = box.first[1]; j < box.end[1]; ++j) {
                    for (int k = box.first[2]; k < box.end[2]; ++k) {
                        ++count[{box.patch, i, j, k}];
                    }
                }
            }
        }
    }
    return count;
}

}  // namespace

TEST_CASE("partition: every element goes to one part, parts are of about one size") {
    const std::vector<std::array<int, 3>> n = {{8, 6, 4}, {3, 3, 3}, {10, 2, 5}};
    const int n_all = 192 + 27 + 100;
    for (int n_parts = 1; n_parts <= 12; ++n_parts) {
        const Parts parts = parts_of_row(n, n_parts);
        REQUIRE(parts.size() == static_cast<std::size_t>(n_parts));
        const auto count = count_elements(parts);
        CHECK(count.size() == n_all);
        for (const auto& [element, times] : count) {
            CHECK(times == 1);
        }
        for (const auto& boxes : parts) {
            std::map<int, int> boxes_of_patch;
            std::int64_t size = 0;
            for (const ElementBox<3>& box : boxes) {
                CHECK(++boxes_of_patch[box.patch] == 1);
                size += box.n_elements();
            }
            CHECK(size > 0.5 * n_all / n_parts);
            CHECK(size < 1.6 * n_all / n_parts);
        }
    }
}

TEST_CASE("partition: as many parts as elements") {
    const Parts parts = parts_of_row({{3, 3, 1}}, 9);
    for (const auto& boxes : parts) {
        REQUIRE(boxes.size() == 1);
        CHECK(boxes.front().n_elements() == 1);
    }
    CHECK(count_elements(parts).size() == 9);
}

TEST_CASE("partition: a long row is cut across, not along") {
    const Parts parts = parts_of_row({{40, 4, 4}}, 4);
    for (const auto& boxes : parts) {
        REQUIRE(boxes.size() == 1);
        CHECK(boxes.front().end[0] - boxes.front().first[0] == 10);
    }
}

TEST_CASE("partition: more parts than elements") {
    CHECK_THROWS_WITH(parts_of_row({{2, 1, 1}}, 3),
                      "3 ranks for 2 elements; each rank takes at least one element: start fewer "
                      "ranks or take more 'elements' in [discretization]");
    CHECK_THROWS_AS(parts_of_row({{2, 1, 1}}, 0), InputError);
}

}  // namespace couture::iga
