#include "io/color_map.h"

#include <algorithm>
#include <cmath>

namespace couture::io {

Color viridis(double t) {
    constexpr std::array<std::array<int, 3>, 11> stops{{{68, 1, 84},
                                                        {72, 36, 117},
                                                        {65, 68, 135},
                                                        {53, 95, 141},
                                                        {42, 120, 142},
                                                        {33, 145, 140},
                                                        {34, 168, 132},
                                                        {68, 191, 112},
                                                        {122, 209, 81},
                                                        {189, 223, 38},
                                                        {253, 231, 37}}};
    const double x = std::clamp(t, 0.0, 1.0) * (stops.size() - 1);
    const std::size_t i = std::min(static_cast<std::size_t>(x), stops.size() - 2);
    const double part = x - static_cast<double>(i);
    Color color{};
    for (int c = 0; c < 3; ++c) {
        color[c] = ((1.0 - part) * stops[i][c] + part * stops[i + 1][c]) / 255.0;
    }
    return color;
}

Color part_color(int i) {
    constexpr std::array<Color, 8> colors{{{0.62, 0.74, 0.85},
                                           {0.94, 0.78, 0.58},
                                           {0.67, 0.81, 0.64},
                                           {0.86, 0.67, 0.68},
                                           {0.76, 0.70, 0.85},
                                           {0.93, 0.88, 0.62},
                                           {0.62, 0.82, 0.80},
                                           {0.80, 0.76, 0.71}}};
    return colors[static_cast<std::size_t>(i) % colors.size()];
}

std::vector<double> round_ticks(double low, double high) {
    if (!(high > low)) {
        return {low};
    }
    constexpr double wanted = 6.0;
    const double power = std::pow(10.0, std::floor(std::log10((high - low) / wanted)));
    double step = 10.0 * power;
    for (const double factor : {1.0, 2.0, 2.5, 5.0}) {
        if ((high - low) / (factor * power) <= wanted) {
            step = factor * power;
            break;
        }
    }
    // Ends count although rounding may put them just outside.
    const double slack = 1e-9 * (high - low) / step;
    std::vector<double> ticks;
    for (double i = std::ceil(low / step - slack); i <= high / step + slack; i += 1.0) {
        ticks.push_back(i == 0.0 ? 0.0 : i * step);
    }
    return ticks;
}

}  // namespace couture::io
