#pragma once

#include <functional>
#include <span>

namespace couture::meshing {

/// The first of some items whose cost is the least one or larger by no more than a tolerance. Costs
/// are asked for in the order of their lower bounds, until the next bound is beyond the least.
///
/// @param bounds     for each item, at least one; not larger than its cost
/// @param cost       of an item by its number; called at most once for each
/// @param tolerance  relative
[[nodiscard]] int find_least_cost(std::span<const double> bounds,
                                  const std::function<double(int)>& cost, double tolerance);

}  // namespace couture::meshing
