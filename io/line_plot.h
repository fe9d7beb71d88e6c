#pragma once

#include <string>
#include <vector>

#include "io/picture.h"

namespace couture::io {

struct LinePlotLabels {
    std::string title;
    /// Below the horizontal axis, and above the vertical one.
    std::string x;
    std::string y;
};

/// A polyline of values against their numbers 0, 1, 2, ..., a mark at each, with axes and round
/// numbers along them; to be drawn alone or beside other scenes.
///
/// @throws InputError  if there is no value or one is not finite
[[nodiscard]] Scene make_line_plot(const VectorX& values, const LinePlotLabels& labels);
/// The same against rising numbers of their own. @throws InputError  also for another number of x
[[nodiscard]] Scene make_line_plot(const VectorX& x, const VectorX& values,
                                   const LinePlotLabels& labels);

/// A quantity that is drawn upwards, from its least value to its largest.
struct ParallelAxis {
    std::string name;
    double low = 0.0;
    double high = 1.0;
};
/// Points of many dimensions, each drawn as a line through its values on all axes.
struct ParallelLines {
    /// n x n_axes.
    MatrixX points;
    Color color;
    /// Pixels.
    double width = 1.0;
};

/// Parallel coordinates: axes side by side, later lines in front.
///
/// @throws InputError  without axes, if an axis has no length, a point has another number of
///                     values, or one is not finite
[[nodiscard]] Scene make_parallel_plot(const std::vector<ParallelAxis>& axes,
                                       const std::vector<ParallelLines>& lines,
                                       const std::string& title);

}  // namespace couture::io
