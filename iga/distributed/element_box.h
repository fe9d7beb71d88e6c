#pragma once

#include <array>
#include <cstdint>

namespace couture::iga {

/// A box of elements of one patch: from `first` on and before `end` in each direction.
template <int d>
struct ElementBox {
    int patch = 0;
    std::array<int, d> first{};
    std::array<int, d> end{};

    [[nodiscard]] std::int64_t n_elements() const {
        std::int64_t n = 1;
        for (int k = 0; k < d; ++k) {
            n *= end[k] - first[k];
        }
        return n;
    }
    [[nodiscard]] bool contains(const std::array<int, d>& element) const {
        for (int k = 0; k < d; ++k) {
            if (element[k] < first[k] || element[k] >= end[k]) {
                return false;
            }
        }
        return true;
    }
    bool operator==(const ElementBox&) const = default;
};

}  // namespace couture::iga
