#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "tests/meshing/parts/part_probe.h"

namespace couture::meshing {

namespace {

using std::numbers::pi;

/// Rounding of sums of some hundred quadrature points.
constexpr double rounding = 1e-13;

double plane_volume(const std::string& name, const std::map<std::string, double>& values = {}) {
    return iga::volume(make_plane_part(name, values));
}

double solid_volume(const std::string& name, const std::map<std::string, double>& values = {}) {
    return iga::volume(make_solid_part(name, values));
}

std::function<double(const VectorX&)> off_sphere(double radius) {
    return [radius](const VectorX& x) { return x.norm() / radius - 1.0; };
}

std::function<double(const VectorX&)> off_circle(double radius) {
    return [radius](const VectorX& x) { return std::hypot(x[0], x[1]) / radius - 1.0; };
}

std::function<double(const VectorX&)> off_ellipse(double a, double b) {
    return [a, b](const VectorX& x) { return std::hypot(x[0] / a, x[1] / b) - 1.0; };
}

std::function<double(const VectorX&)> coordinate(int axis, double value = 0.0) {
    return [axis, value](const VectorX& x) { return x[axis] - value; };
}

/// Integral of |sum_k B_k e^(i k twist / 3)|^2 over [0, 1] for cubic Bernstein polynomials.
double section_scale(double twist) {
    constexpr std::array<double, 4> three = {1, 3, 3, 1};
    constexpr std::array<double, 7> six = {1, 6, 15, 20, 15, 6, 1};
    double sum = 0.0;
    for (int j = 0; j < 4; ++j) {
        for (int k = 0; k < 4; ++k) {
            sum += std::cos((j - k) * twist / 3) * three[j] * three[k] / (7 * six[j + k]);
        }
    }
    return sum;
}

}  // namespace

TEST_CASE("parts: areas of plane parts are exact", "[parts]") {
    CHECK(plane_volume("rectangle", {{"length_x", 3}}) == Approx(3).epsilon(rounding));
    CHECK(plane_volume("quarter_annulus") == Approx(0.75 * pi).epsilon(rounding));
    CHECK(plane_volume("thick_cylinder", {{"outer_radius", 3}}) ==
          Approx(2 * pi).epsilon(rounding));
    CHECK(plane_volume("half_annulus") == Approx(1.5 * pi).epsilon(rounding));
    CHECK(plane_volume("plate_with_hole") == Approx(16 - pi / 4).epsilon(rounding));
    CHECK(plane_volume("le1_membrane") ==
          Approx(pi / 4 * (3.25 * 2.75 - 2.0 * 1.0)).epsilon(rounding));
    CHECK(plane_volume("cook") == Approx(48.0 * (44 + 16) / 2).epsilon(rounding));
}

TEST_CASE("parts: volumes of solid parts are exact", "[parts]") {
    CHECK(solid_volume("box", {{"length_z", 4}}) == Approx(4).epsilon(rounding));
    CHECK(solid_volume("cantilever") == Approx(10).epsilon(rounding));
    CHECK(solid_volume("quarter_annulus_3d") == Approx(0.75 * pi).epsilon(rounding));
    CHECK(solid_volume("thick_cylinder_3d", {{"length", 5}}) ==
          Approx(3.75 * pi).epsilon(rounding));
    CHECK(solid_volume("cylinder_o_grid") == Approx(2 * pi).epsilon(rounding));
    CHECK(solid_volume("plate_with_hole_3d", {{"thickness", 2}}) ==
          Approx(32 - pi / 2).epsilon(rounding));
    CHECK(solid_volume("hollow_sphere") == Approx(pi / 6 * (8 - 1)).epsilon(rounding));
    CHECK(solid_volume("le10_plate") ==
          Approx(0.6 * pi / 4 * (3.25 * 2.75 - 2.0 * 1.0)).epsilon(rounding));
    CHECK(solid_volume("cook_3d", {{"thickness", 2}}) == Approx(2 * 1440.0).epsilon(rounding));
    CHECK(solid_volume("scordelis_lo") ==
          Approx(25 * 0.25 * (40 * pi / 180) * 25).epsilon(rounding));
    CHECK(solid_volume("pinched_cylinder") == Approx(300 * 3 * pi / 2 * 300).epsilon(rounding));
}

TEST_CASE("twisted_box: the volume follows from the shrunken sections", "[parts]") {
    for (const double twist : {-1.5, 0.0, 0.6}) {
        CHECK(solid_volume("twisted_box", {{"twist", twist}, {"width", 3}}) ==
              Approx(9 * 2 * section_scale(twist)).epsilon(rounding));
    }
}

TEST_CASE("parts: the numbers of patches and interfaces", "[parts]") {
    const auto counts = [](const auto& part) {
        return std::array<std::size_t, 3>{part.patches.size(), part.interfaces.size(),
                                          part.outer_sides().size()};
    };
    using Counts = std::array<std::size_t, 3>;
    CHECK(counts(make_plane_part("half_annulus")) == Counts{2, 1, 6});
    CHECK(counts(make_plane_part("plate_with_hole")) == Counts{2, 1, 6});
    CHECK(counts(make_solid_part("plate_with_hole_3d")) == Counts{2, 1, 10});
    CHECK(counts(make_solid_part("hollow_sphere")) == Counts{3, 3, 12});
    CHECK(counts(make_solid_part("le10_plate")) == Counts{2, 1, 10});
    CHECK(counts(make_solid_part("cylinder_o_grid")) == Counts{5, 8, 14});
}

TEST_CASE("hollow_sphere: walls are exact spheres and cuts are plane", "[parts]") {
    const iga::MultiPatch<3> sphere = make_solid_part("hollow_sphere");
    CHECK(largest_on<3>(sphere, "inner", off_sphere(1.0)) < rounding);
    CHECK(largest_on<3>(sphere, "outer", off_sphere(2.0)) < rounding);
    CHECK(largest_on<3>(sphere, "cut_x", coordinate(0)) < rounding);
    CHECK(largest_on<3>(sphere, "cut_y", coordinate(1)) < rounding);
    CHECK(largest_on<3>(sphere, "cut_z", coordinate(2)) < rounding);
    for (const char* cut : {"cut_x", "cut_y", "cut_z"}) {
        CHECK(sphere.boundary_set(cut).size() == 2);
    }
}

TEST_CASE("parts: curved sides lie on their circles and ellipses", "[parts]") {
    const iga::MultiPatch<2> plate = make_plane_part("plate_with_hole", {{"hole_radius", 0.3}});
    CHECK(largest_on<2>(plate, "hole", off_circle(0.3)) < rounding);
    const iga::MultiPatch<2> half = make_plane_part("half_annulus");
    CHECK(largest_on<2>(half, "inner", off_circle(1.0)) < rounding);
    CHECK(largest_on<2>(half, "axis", coordinate(0)) < rounding);
    CHECK(largest_on<3>(make_solid_part("cylinder_o_grid"), "wall", off_circle(1.0)) < rounding);
    const iga::MultiPatch<2> membrane = make_plane_part("le1_membrane");
    CHECK(largest_on<2>(membrane, "ad", off_ellipse(2.0, 1.0)) < rounding);
    CHECK(largest_on<2>(membrane, "bc", off_ellipse(3.25, 2.75)) < rounding);
    CHECK(largest_on<2>(membrane, "ab", coordinate(0)) < rounding);
    CHECK(largest_on<2>(membrane, "cd", coordinate(1)) < rounding);
}

TEST_CASE("le10_plate: supports and load are where NAFEMS has them", "[parts]") {
    const iga::MultiPatch<3> plate = make_solid_part("le10_plate");
    CHECK(largest_on<3>(plate, "adad", off_ellipse(2.0, 1.0)) < rounding);
    CHECK(largest_on<3>(plate, "bcbc", off_ellipse(3.25, 2.75)) < rounding);
    CHECK(largest_on<3>(plate, "abab", coordinate(0)) < rounding);
    CHECK(largest_on<3>(plate, "dcdc", coordinate(1)) < rounding);
    CHECK(largest_on<3>(plate, "top", coordinate(2, 0.6)) < rounding);
    CHECK(largest_on<3>(plate, "bottom", coordinate(2)) < rounding);
    CHECK(largest_on<3>(plate, "mid_line", coordinate(2, 0.3)) < rounding);
    CHECK(largest_on<3>(plate, "mid_line", off_ellipse(3.25, 2.75)) < rounding);
    CHECK(plate.boundary_set("mid_line").at(0).dimension() == 1);
}

TEST_CASE("parts: shells have their sets at the ends, the crown and the edge", "[parts]") {
    const iga::MultiPatch<3> roof = make_solid_part("scordelis_lo");
    const double angle = 40 * pi / 180;
    const double size = 25.0;
    CHECK(largest_on<3>(roof, "diaphragm", coordinate(1)) == 0.0);
    CHECK(largest_on<3>(roof, "mid_span", coordinate(1, 25.0)) < rounding * size);
    CHECK(largest_on<3>(roof, "crown", coordinate(0)) < rounding * size);
    CHECK(largest_on<3>(roof, "free_edge", [angle](const VectorX& x) {
              return std::atan2(x[0], x[2]) - angle;
          }) < rounding);
    CHECK(largest_on<3>(roof, "outer", [](const VectorX& x) {
              return std::hypot(x[0], x[2]) / 25.125 - 1.0;
          }) < rounding);
    const iga::MultiPatch<3> cylinder = make_solid_part("pinched_cylinder");
    CHECK(largest_on<3>(cylinder, "cut_z", coordinate(2)) < rounding * 300);
    CHECK(largest_on<3>(cylinder, "load_line", coordinate(0)) < rounding * 300);
    CHECK(largest_on<3>(cylinder, "load_line", coordinate(1, 300.0)) < rounding * 300);
    CHECK(largest_on<3>(cylinder, "load_point", coordinate(2, 301.5)) < rounding * 300);
}

}  // namespace couture::meshing
