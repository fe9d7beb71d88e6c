#include "meshing/parts/sheet_map.h"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <vector>

namespace couture::meshing {

using std::numbers::pi;

namespace {

struct Sheet {
    SheetMap map;
    /// Where it is probed.
    Vector2 centre;
    /// Distance of a point from the surface, negative inside.
    std::function<double(const Vector3&)> distance;
};

std::vector<Sheet> sheets() {
    const Vector3 centre(1.0, -2.0, 0.5);
    const auto radial = [centre](const Vector3& x) {
        return std::hypot(x.x() - centre.x(), x.y() - centre.y());
    };
    const auto torus_distance = [=](const Vector3& x) {
        return std::hypot(radial(x) - 5.0, x.z() - centre.z()) - 2.0;
    };
    return {
        {coordinate_plane_map(0, 1, centre), {0.3, 0.4}, [](const auto& x) { return x.x() - 1; }},
        {coordinate_plane_map(1, -1, centre), {0.3, 0.4}, [](const auto& x) { return -x.y() - 2; }},
        {plane_map(centre, Vector3::UnitY(), Vector3::UnitX()),
         {0.3, 0.4},
         [](const auto& x) { return 0.5 - x.z(); }},
        {cylinder_map(centre, 3.0, 0.5 * pi, Facing::outwards),
         {3.0 * 0.7 * pi, 0.4},
         [=](const auto& x) { return radial(x) - 3.0; }},
        {cylinder_map(centre, 3.0, pi, Facing::inwards),
         {-3.0 * 1.2 * pi, 0.4},
         [=](const auto& x) { return 3.0 - radial(x); }},
        {torus_map(centre, 5.0, 2.0, {0.0, 0.5 * pi}), {0.3, 0.4}, torus_distance},
        {torus_map(centre, 5.0, 2.0, {pi, -0.5 * pi}), {2.5, -1.2}, torus_distance}};
}

}  // namespace

TEST_CASE("sheet map: to space and back, on the surface", "[parts]") {
    constexpr double rounding = 1e-13;
    for (const Sheet& sheet : sheets()) {
        const Vector3 x = sheet.map.to_space(sheet.centre);
        CHECK((sheet.map.to_plane(x) - sheet.centre).norm() < 10 * rounding);
        CHECK(std::abs(sheet.distance(x)) < rounding);
    }
}

TEST_CASE("sheet map: conformal with the given scale, the normal outwards", "[parts]") {
    constexpr double step = 1e-5;
    constexpr double difference = 1e-8;
    for (const Sheet& sheet : sheets()) {
        const auto derivative = [&](const Vector2& direction) -> Vector3 {
            return (sheet.map.to_space(sheet.centre + step * direction) -
                    sheet.map.to_space(sheet.centre - step * direction)) /
                   (2 * step);
        };
        const Vector3 u = derivative(Vector2::UnitX());
        const Vector3 v = derivative(Vector2::UnitY());
        const double scale = sheet.map.scale ? sheet.map.scale(sheet.centre) : 1.0;
        CHECK(u.norm() == Approx(scale).epsilon(difference));
        CHECK(v.norm() == Approx(scale).epsilon(difference));
        CHECK(std::abs(u.dot(v)) < difference * scale * scale);
        constexpr double outside = 0.01;
        const Vector3 x = sheet.map.to_space(sheet.centre);
        CHECK(sheet.distance(x + outside * u.cross(v).normalized()) ==
              Approx(outside).epsilon(0.01));
    }
}

TEST_CASE("sheet map: half turns away from the middle there is no jump", "[parts]") {
    const SheetMap map = cylinder_map(Vector3::Zero(), 2.0, 0.5 * pi, Facing::outwards);
    CHECK(map.to_plane({2.0, 0.0, 0.0}).x() == Approx(0.0).margin(1e-14));
    CHECK(map.to_plane({-2.0, 1e-17, 0.0}).x() == Approx(2.0 * pi));
    CHECK(map.to_plane({-2.0, -1e-17, 0.0}).x() == Approx(2.0 * pi));
    CHECK(map.radius({0.0, 0.0}) == 2.0);
}

}  // namespace couture::meshing
