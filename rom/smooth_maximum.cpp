#include "rom/smooth_maximum.h"

#include <cassert>
#include <cmath>

namespace couture::rom {

SmoothMaximum smooth_maximum(const VectorX& values, double sharpness) {
    assert(values.size() > 0 && sharpness > 0.0);
    const double largest = values.maxCoeff();
    SmoothMaximum result;
    result.weights = (sharpness * (values.array() - largest)).exp();
    const double sum = result.weights.sum();
    result.value = largest + std::log(sum) / sharpness;
    result.weights /= sum;
    return result;
}

}  // namespace couture::rom
