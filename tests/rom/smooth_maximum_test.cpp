#include "rom/smooth_maximum.h"

#include <catch2/catch.hpp>
#include <cmath>

using namespace couture;
using namespace couture::rom;

TEST_CASE("smooth_maximum: lies between the largest value and the bound above it", "[rom]") {
    const Vector<4> values(0.3, 1.0, 0.9, -5.0);
    for (const double sharpness : {1.0, 30.0, 3000.0}) {
        const SmoothMaximum smooth = smooth_maximum(values, sharpness);
        CHECK(smooth.value >= 1.0);
        CHECK(smooth.value <= 1.0 + std::log(4.0) / sharpness);
        CHECK(smooth.weights.sum() == Approx(1.0).epsilon(1e-14));
    }
    // Of equal values the bound itself, whatever their size.
    CHECK(smooth_maximum(Vector3::Constant(1e6), 10.0).value ==
          Approx(1e6 + std::log(3.0) / 10.0).epsilon(1e-14));
}

TEST_CASE("smooth_maximum: weights are its derivatives", "[rom]") {
    const Vector3 values(0.3, 0.5, 0.45);
    constexpr double sharpness = 20.0;
    constexpr double step = 1e-6;
    const SmoothMaximum smooth = smooth_maximum(values, sharpness);
    for (int i = 0; i < 3; ++i) {
        const Vector3 shift = step * Vector3::Unit(i);
        const double slope = (smooth_maximum(values + shift, sharpness).value -
                              smooth_maximum(values - shift, sharpness).value) /
                             (2.0 * step);
        CHECK(smooth.weights[i] == Approx(slope).epsilon(1e-7));
    }
}
