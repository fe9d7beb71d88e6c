#pragma once

#include <fmt/format.h>

#include <string>

#include "iga/core/types.h"

namespace couture {

/// "(0.5, 0, 1.25)", six digits.
template <typename Derived>
[[nodiscard]] std::string format_point(const Eigen::MatrixBase<Derived>& point) {
    std::string text = "(";
    for (Eigen::Index i = 0; i < point.size(); ++i) {
        text += fmt::format("{}{:.6g}", i == 0 ? "" : ", ", point(i));
    }
    return text + ")";
}

}  // namespace couture
