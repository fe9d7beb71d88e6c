#include "io/line_plot.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "iga/core/error.h"

namespace couture::io {

namespace {

// The rectangle of the axes; the picture is a little larger.
constexpr double width = 1.4;
constexpr double height = 1.0;
constexpr Color axis_color{0.12, 0.14, 0.17};
constexpr Color line_color{0.12, 0.38, 0.68};

// 1, 2 or 5 times a power of ten, with at most n steps in the range.
double round_step(double range, int n) {
    const double least = range / n;
    const double power = std::pow(10.0, std::floor(std::log10(least)));
    for (const double factor : {1.0, 2.0, 5.0}) {
        if (factor * power >= least) return factor * power;
    }
    return 10.0 * power;
}

// Values at the ends of an axis, both multiples of the step between its numbers.
struct Axis {
    double low;
    double high;
    double step;

    Axis(double least, double most, double smallest_step) {
        const double range = most > least ? most - least : std::max(std::abs(most), 1.0);
        constexpr int n_steps = 5;
        step = std::max(round_step(range, n_steps), smallest_step);
        low = step * std::floor(least / step);
        high = step * std::ceil(most / step);
        if (!(high > low)) high = low + step;
    }
    [[nodiscard]] double fraction(double value) const { return (value - low) / (high - low); }
    [[nodiscard]] int n_steps() const { return static_cast<int>(std::lround((high - low) / step)); }
    [[nodiscard]] std::string text(int k) const { return fmt::format("{:.6g}", low + k * step); }
};

CurvePiece line(const MatrixX& points, const Color& color, double pixels, bool is_closed = false) {
    return {.points = points, .is_closed = is_closed, .color = color, .width = pixels};
}

CurvePiece segment(double x0, double y0, double x1, double y1, const Color& color) {
    MatrixX points(2, 3);
    points << x0, y0, 0.0, x1, y1, 0.0;
    return line(points, color, 1.5);
}

void add_axes(const Axis& x, const Axis& y, const LinePlotLabels& labels, Scene& scene) {
    constexpr double tick = 0.015;
    scene.curves.push_back(segment(0.0, 0.0, width, 0.0, axis_color));
    scene.curves.push_back(segment(0.0, 0.0, 0.0, height, axis_color));
    for (int k = 0; k <= x.n_steps(); ++k) {
        const double at = width * k / x.n_steps();
        scene.curves.push_back(segment(at, -tick, at, 0.0, axis_color));
        scene.labels.push_back({.position = {at, -0.055, 0.0}, .text = x.text(k)});
    }
    for (int k = 0; k <= y.n_steps(); ++k) {
        const double at = height * k / y.n_steps();
        scene.curves.push_back(segment(-tick, at, 0.0, at, axis_color));
        scene.labels.push_back({.position = {-0.09, at, 0.0}, .text = y.text(k)});
    }
    scene.labels.push_back({.position = {0.5 * width, -0.13, 0.0}, .text = labels.x});
    scene.labels.push_back({.position = {0.0, height + 0.07, 0.0}, .text = labels.y});
}

// A small square on its corner.
CurvePiece mark(double x, double y) {
    constexpr double r = 0.008;
    MatrixX points(4, 3);
    points << x - r, y, 0.0, x, y - r, 0.0, x + r, y, 0.0, x, y + r, 0.0;
    return line(points, line_color, 3.0, true);
}

// Seen from above, with room for the axes' numbers.
void look_down(const std::string& title, Scene& scene) {
    scene.title = title;
    scene.view_direction = -Vector3::UnitZ();
    scene.up = Vector3::UnitY();
    scene.show_axes = false;
    scene.frame = ViewFrame{.center = {0.47 * width, 0.47 * height}, .height = 1.35 * height};
}

void require_finite(const MatrixX& values, const char* plot) {
    for (Eigen::Index k = 0; k < values.size(); ++k) {
        if (!std::isfinite(values.data()[k])) {
            throw InputError("{}: value {} is {}; it must be finite", plot, k, values.data()[k]);
        }
    }
}

}  // namespace

Scene make_line_plot(const VectorX& values, const LinePlotLabels& labels) {
    return make_line_plot(
        VectorX::LinSpaced(values.size(), 0.0, static_cast<double>(values.size() - 1)), values,
        labels);
}

Scene make_line_plot(const VectorX& x_values, const VectorX& values, const LinePlotLabels& labels) {
    if (values.size() == 0) throw InputError("make_line_plot: no values; there is nothing to show");
    if (x_values.size() != values.size()) {
        throw InputError("make_line_plot: {} x for {} values", x_values.size(), values.size());
    }
    require_finite(x_values, "make_line_plot");
    require_finite(values, "make_line_plot");
    const Axis x(x_values.minCoeff(), x_values.maxCoeff(), 1.0);
    const Axis y(values.minCoeff(), values.maxCoeff(), 0.0);
    Scene scene;
    add_axes(x, y, labels, scene);
    MatrixX points(values.size(), 3);
    for (Eigen::Index k = 0; k < values.size(); ++k) {
        points.row(k) << width * x.fraction(x_values[k]), height * y.fraction(values[k]), 0.0;
        scene.curves.push_back(mark(points(k, 0), points(k, 1)));
    }
    if (values.size() > 1) scene.curves.push_back(line(points, line_color, 2.2));
    look_down(labels.title, scene);
    return scene;
}

Scene make_parallel_plot(const std::vector<ParallelAxis>& axes,
                         const std::vector<ParallelLines>& lines, const std::string& title) {
    if (axes.empty()) throw InputError("make_parallel_plot: no axes; there is nothing to show");
    const auto n_axes = static_cast<Eigen::Index>(axes.size());
    const auto at = [&](Eigen::Index k) {
        return n_axes == 1 ? 0.5 * width
                           : width * static_cast<double>(k) / static_cast<double>(n_axes - 1);
    };
    Scene scene;
    for (const ParallelLines& group : lines) {
        if (group.points.cols() != n_axes) {
            throw InputError("make_parallel_plot: points of {} values for {} axes",
                             group.points.cols(), n_axes);
        }
        require_finite(group.points, "make_parallel_plot");
        for (Eigen::Index i = 0; i < group.points.rows(); ++i) {
            MatrixX points(n_axes, 3);
            for (Eigen::Index k = 0; k < n_axes; ++k) {
                const ParallelAxis& axis = axes[k];
                points.row(k) << at(k),
                    height * (group.points(i, k) - axis.low) / (axis.high - axis.low), 0.0;
            }
            scene.curves.push_back(line(points, group.color, group.width));
        }
    }
    for (Eigen::Index k = 0; k < n_axes; ++k) {
        const ParallelAxis& axis = axes[k];
        if (!(axis.high > axis.low)) {
            throw InputError("make_parallel_plot: axis '{}' goes from {} to {}; it must rise",
                             axis.name, axis.low, axis.high);
        }
        scene.curves.push_back(segment(at(k), 0.0, at(k), height, axis_color));
        // Every other name lower, as they are wider than the gaps.
        const double lower = k % 2 == 0 ? 0.0 : 0.06;
        scene.labels.push_back(
            {.position = {at(k), -0.05, 0.0}, .text = fmt::format("{:.6g}", axis.low)});
        scene.labels.push_back(
            {.position = {at(k), height + 0.04, 0.0}, .text = fmt::format("{:.6g}", axis.high)});
        scene.labels.push_back({.position = {at(k), -0.11 - lower, 0.0}, .text = axis.name});
    }
    look_down(title, scene);
    return scene;
}

}  // namespace couture::io
