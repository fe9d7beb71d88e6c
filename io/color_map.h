#pragma once

#include <array>
#include <vector>

namespace couture::io {

/// Red, green, blue in [0, 1].
using Color = std::array<double, 3>;

/// Viridis, which is perceptually uniform, at t in [0, 1]. Source: [SmithVanDerWalt15].
[[nodiscard]] Color viridis(double t);
/// Colours that tell parts apart; repeats after eight.
[[nodiscard]] Color part_color(int i);

/// Round numbers from `low` to `high`, between three and about seven of them; `low` alone if both
/// are equal.
[[nodiscard]] std::vector<double> round_ticks(double low, double high);

/// Steps of the colour map in pictures.
constexpr int n_colors = 256;

}  // namespace couture::io
