#include "io/line_plot.h"

#include <catch2/catch.hpp>
#include <limits>

#include "iga/core/error.h"

using namespace couture;
using namespace couture::io;

namespace {

// The polyline is drawn last.
const MatrixX& polyline(const Scene& scene) { return scene.curves.back().points; }

}  // namespace

TEST_CASE("line plot: values stand where the axes' numbers say", "[io]") {
    const Scene scene =
        make_line_plot(VectorX{{7.0, 3.0, 1.2}}, {.title = "t", .x = "step", .y = "energy"});
    REQUIRE(polyline(scene).rows() == 3);
    const auto position = [&](const std::string& text) {
        for (const Label& label : scene.labels) {
            if (label.text == text) return label.position;
        }
        FAIL("no label " << text);
        return Vector3(Vector3::Zero());
    };
    // Numbers along y are 0, 2, ..., 8, along x 0, 1, 2.
    const double low = position("4").y();
    const double high = position("6").y();
    for (int k = 0; k < 2; ++k) {
        const double value = k == 0 ? 7.0 : 3.0;
        CHECK(polyline(scene)(k, 1) == Approx(low + (value - 4.0) * (high - low) / 2.0));
    }
    CHECK(polyline(scene)(1, 0) == Approx(position("1").x()));
    CHECK(scene.title == "t");
}

TEST_CASE("line plot: one value, equal values; none or infinite ones are refused", "[io]") {
    CHECK_NOTHROW(make_line_plot(VectorX{{2.0}}, {}));
    const Scene level = make_line_plot(VectorX::Constant(4, -3.0), {});
    CHECK(polyline(level).col(1).maxCoeff() == polyline(level).col(1).minCoeff());
    CHECK(polyline(level).allFinite());
    CHECK_THROWS_AS(make_line_plot(VectorX(), {}), InputError);
    CHECK_THROWS_WITH(make_line_plot(VectorX{{1.0, std::numeric_limits<double>::infinity()}}, {}),
                      Catch::Contains("value 1 is inf"));
}
