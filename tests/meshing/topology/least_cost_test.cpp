#include "meshing/topology/least_cost.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <vector>

using namespace couture::meshing;

TEST_CASE("find_least_cost: the first of the least, as if all costs were known",
          "[meshing][topology]") {
    constexpr double tolerance = 1e-9;
    std::mt19937 random(7);
    std::size_t n_asked = 0;
    std::size_t n_items = 0;
    for (int round = 0; round < 200; ++round) {
        std::vector<double> costs;
        std::vector<double> bounds;
        for (int k = 0; k < 40; ++k) {
            // Many are equal but for rounding.
            const double exact = 4.0 + static_cast<double>(random() % 8);
            costs.push_back(exact * (1.0 + 1e-12 * static_cast<double>(random() % 3)));
            bounds.push_back(exact * (1.0 - 0.02 * static_cast<double>(random() % 15)));
        }
        double least = costs.front();
        for (const double cost : costs) least = std::min(least, cost);
        int expected = 0;
        while (costs[expected] > (1.0 + tolerance) * least) ++expected;
        std::vector<int> n_asked_of(costs.size(), 0);
        const int found = find_least_cost(
            bounds,
            [&](int k) {
                ++n_asked_of[k];
                ++n_asked;
                return costs[k];
            },
            tolerance);
        REQUIRE(found == expected);
        for (const int n : n_asked_of) REQUIRE(n <= 1);
        n_items += costs.size();
    }
    // Bounds that are close spare most of them.
    REQUIRE(n_asked < n_items / 2);
}
