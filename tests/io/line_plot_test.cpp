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

TEST_CASE("line plot: numbers of their own along x", "[io]") {
    const Scene scene = make_line_plot(VectorX{{10.0, 20.0, 40.0}}, VectorX{{1.0, 1.0, 1.0}}, {});
    const MatrixX& points = polyline(scene);
    CHECK(points(2, 0) - points(1, 0) == Approx(2.0 * (points(1, 0) - points(0, 0))));
    CHECK_THROWS_AS(make_line_plot(VectorX{{1.0}}, VectorX{{1.0, 2.0}}, {}), InputError);
}

TEST_CASE("parallel plot: a point is a line through its values on all axes", "[io]") {
    const std::vector<ParallelAxis> axes{{"a", 0.0, 2.0}, {"b", 10.0, 20.0}, {"c", -1.0, 1.0}};
    const MatrixX point{{1.0, 20.0, -1.0}};
    const Scene scene = make_parallel_plot(axes, {{point, Color{}, 1.0}}, "design");
    const MatrixX& drawn = scene.curves.front().points;
    const double height = drawn(1, 1);
    CHECK(drawn(0, 1) == Approx(0.5 * height));
    CHECK(drawn(2, 1) == Approx(0.0).margin(1e-12));
    CHECK(drawn(1, 0) - drawn(0, 0) == Approx(drawn(2, 0) - drawn(1, 0)));
    CHECK(scene.title == "design");

    CHECK_THROWS_AS(make_parallel_plot({}, {}, ""), InputError);
    CHECK_THROWS_WITH(make_parallel_plot({{"a", 1.0, 1.0}}, {}, ""), Catch::Contains("'a'"));
    const MatrixX short_point{{1.0, 2.0}};
    CHECK_THROWS_AS(make_parallel_plot(axes, {{short_point, Color{}, 1.0}}, ""), InputError);
    const MatrixX no_number{{1.0, std::numeric_limits<double>::quiet_NaN(), 0.0}};
    CHECK_THROWS_AS(make_parallel_plot(axes, {{no_number, Color{}, 1.0}}, ""), InputError);
}
