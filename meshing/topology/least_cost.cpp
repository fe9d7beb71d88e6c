#include "meshing/topology/least_cost.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

namespace couture::meshing {

int find_least_cost(std::span<const double> bounds, const std::function<double(int)>& cost,
                    double tolerance) {
    std::vector<int> order(bounds.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
                     [&](int a, int b) { return bounds[a] < bounds[b]; });
    constexpr double unknown = std::numeric_limits<double>::infinity();
    std::vector<double> costs(bounds.size(), unknown);
    double least = unknown;
    double largest_equal = unknown;
    for (const int item : order) {
        if (bounds[item] > largest_equal) break;
        costs[item] = cost(item);
        least = std::min(least, costs[item]);
        largest_equal = least + tolerance * std::abs(least);
    }
    const auto first = std::find_if(costs.begin(), costs.end(),
                                    [&](double value) { return value <= largest_equal; });
    return static_cast<int>(first - costs.begin());
}

}  // namespace couture::meshing
