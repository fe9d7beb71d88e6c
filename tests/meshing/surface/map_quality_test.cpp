#include "meshing/surface/map_quality.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "tests/meshing/surface/map_samples.h"
#include "tests/meshing/surface/surface_samples.h"

using namespace couture;
using namespace couture::meshing;

namespace {

std::vector<Vector2> plane_parameters(const CutSurface& surface) {
    std::vector<Vector2> parameters;
    for (int v = 0; v < surface.n_vertices(); ++v) {
        parameters.emplace_back(surface.point(v).x(), surface.point(v).y());
    }
    return parameters;
}

}  // namespace

TEST_CASE("map_distortion: a similarity has none", "[meshing][surface]") {
    const CutSurface surface(make_jittered_square(6, 1));
    auto parameters = plane_parameters(surface);
    for (Vector2& x : parameters) x = Vector2(-3.0 * x.y(), 3.0 * x.x());
    const MapDistortion distortion = map_distortion(surface, parameters);
    CHECK(distortion.smallest_area_ratio == Approx(1.0));
    CHECK(distortion.largest_area_ratio == Approx(1.0));
    CHECK(distortion.largest_angle_change < 1e-12);
    CHECK(distortion.n_without_area == 0);
}

TEST_CASE("map_distortion: a stretch changes angles as it should", "[meshing][surface]") {
    const CutSurface surface(make_square(1));
    auto parameters = plane_parameters(surface);
    for (Vector2& x : parameters) x.x() *= std::numbers::sqrt3;
    const MapDistortion distortion = map_distortion(surface, parameters);
    CHECK(distortion.largest_area_ratio == Approx(1.0));
    // Right angles stay, 45 degrees become 30 and 60.
    CHECK(distortion.largest_angle_change == Approx(std::numbers::pi / 12.0));
    CHECK(distortion.mean_angle_change == Approx(std::numbers::pi / 18.0));
}

TEST_CASE("flipped_triangles: those that turn the wrong way or have no area",
          "[meshing][surface]") {
    const CutSurface surface(make_square(2));
    auto parameters = plane_parameters(surface);
    CHECK(flipped_triangles(surface, parameters).empty());
    // The middle vertex on the side of its own triangles.
    parameters[4] = parameters[5];
    CHECK_FALSE(flipped_triangles(surface, parameters).empty());
    parameters[4] = {0.75, 0.5};
    CHECK(flipped_triangles(surface, parameters).empty());
    for (Vector2& x : parameters) x.x() = -x.x();
    CHECK(flipped_triangles(surface, parameters).size() == 8);
}
