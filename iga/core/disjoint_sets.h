#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace couture {

/// Disjoint sets of the numbers 0 .. n - 1. The smallest number of a set is its root: roots come
/// first in numbering order.
class DisjointSets {
  public:
    explicit DisjointSets(std::size_t n) : parent_(n) {
        std::iota(parent_.begin(), parent_.end(), 0);
    }

    /// The root of the set that holds i.
    [[nodiscard]] int find(int i) {
        while (parent_[i] != i) {
            parent_[i] = parent_[parent_[i]];
            i = parent_[i];
        }
        return i;
    }
    /// Makes one set of two.
    void join(int i, int j) {
        i = find(i);
        j = find(j);
        parent_[std::max(i, j)] = std::min(i, j);
    }

  private:
    std::vector<int> parent_;
};

}  // namespace couture
