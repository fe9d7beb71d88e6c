#pragma once

#include <string>

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

}  // namespace couture::io
