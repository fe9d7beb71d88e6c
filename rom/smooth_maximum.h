#pragma once

#include "iga/core/types.h"

namespace couture::rom {

struct SmoothMaximum {
    /// Between the largest value and that plus log(n) / sharpness.
    double value = 0.0;
    /// Its derivatives by the values: positive, their sum is 1.
    VectorX weights;
};

/// log(sum exp(sharpness v_i)) / sharpness of at least one value.
///
/// @param sharpness  positive, in the inverse unit of the values
///
/// Source: [KreisselmeierSteinhauser79].
[[nodiscard]] SmoothMaximum smooth_maximum(const VectorX& values, double sharpness);

}  // namespace couture::rom
