#include "meshing/parts/part_surface.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <random>
#include <set>

#include "iga/core/error.h"
#include "tests/meshing/parts/self_intersection.h"
#include "tests/meshing/parts/surface_probe.h"

namespace couture::meshing {

using Catch::Matchers::Contains;
using Catch::Matchers::Equals;
using std::numbers::pi;
using Values = std::map<std::string, double>;

namespace {

/// Edges at which features are found by everyone who looks for them.
constexpr double feature_angle = 40.0;

struct Expected {
    int genus = 0;
    int n_caps = 0;
    /// As the tables of the parts ask for.
    int min_triangles = 0;
    /// Closed form; nothing: none is known.
    std::function<double(const Values&)> volume;
};

double disc(double radius) { return pi * radius * radius; }

/// Area of what a cylinder about z cuts off, between the planes y = +-half_width and x >= 0:
/// integral of sqrt(r^2 - y^2).
double root_area(double radius, double half_width) {
    return half_width * std::sqrt(radius * radius - half_width * half_width) +
           radius * radius * std::asin(half_width / radius);
}

double arm_volume(double half_width, double radius, double height, double length) {
    return height * (2 * half_width * length - root_area(radius, half_width));
}

const std::map<std::string, Expected>& expected() {
    static const std::map<std::string, Expected> all = {
        {"pant",
         {0, 3, 8000,
          [](const Values& v) {
              return 1600.0 * (40 + 90 - v.at("X1") + 90 + v.at("X2") + 110 + v.at("Y3"));
          }}},
        {"double_t", {0, 4, 0, [](const Values&) { return 1600.0 * (260 + 2 * 90); }}},
        {"double_curved_t", {0, 4, 0, [](const Values&) { return 1600.0 * (260 + 2 * 90); }}},
        {"seal",
         {1, 2, 10000,
          [](const Values& v) {
              return v.at("H1") * (disc(v.at("R3")) - disc(v.at("R2"))) +
                     2 * arm_volume(v.at("R1"), v.at("R3"), v.at("H2"), v.at("L1"));
          }}},
        {"half_seal",
         {0, 3, 6000,
          [](const Values& v) {
              return v.at("ring_height") *
                         (disc(v.at("outer_radius")) - disc(v.at("inner_radius"))) / 2 +
                     arm_volume(v.at("arm_half_width"), v.at("outer_radius"), v.at("arm_height"),
                                v.at("arm_length"));
          }}},
        {"wheel",
         {3, 0, 20000,
          [](const Values& v) {
              constexpr double rise = 4.0;
              const double y = v.at("L1") / 2;
              const double window = root_area(v.at("R4"), y) - root_area(v.at("R3"), y);
              return v.at("H1") * (disc(v.at("R3")) - disc(v.at("R1"))) +
                     2 * rise * (disc(v.at("R2")) - disc(v.at("R1"))) +
                     v.at("H2") * (disc(v.at("R5")) - disc(v.at("R3")) - 2 * window) +
                     v.at("H1") * (disc(v.at("R6")) - disc(v.at("R5")));
          }}},
        {"casting",
         {5, 0, 30000,
          [](const Values& v) {
              return v.at("height_B") * (disc(v.at("radius_B")) - 4 * disc(12.0)) +
                     (v.at("height_H") - v.at("height_B")) * disc(v.at("radius_H")) -
                     v.at("height_H") * disc(v.at("radius_I"));
          }}},
        {"plate", {1, 0, 0, [](const Values& v) { return 10 * (20000 - disc(v.at("P1") / 2)); }}},
        {"plate_with_two_holes",
         {2, 0, 0, [](const Values&) { return 10 * (20000 - 2 * disc(25.0)); }}},
        {"torus",
         {1, 0, 0,
          [](const Values& v) { return 2 * pi * v.at("radius") * disc(v.at("tube_radius")); }}},
        {"double_torus", {2, 0, 0, nullptr}},
        {"cube", {0, 0, 0, [](const Values& v) { return std::pow(v.at("length"), 3); }}},
        {"cylinder",
         {0, 2, 0, [](const Values& v) { return v.at("length") * disc(v.at("radius")); }}},
        {"sierpinski",
         {5, 0, 0, [](const Values& v) { return 20.0 / 27.0 * std::pow(v.at("length"), 3); }}}};
    return all;
}

Values defaults(const PartInfo& info) {
    Values values;
    for (const PartParameter& parameter : info.parameters) {
        values[parameter.name] = parameter.value;
    }
    return values;
}

/// The centre, both ends of each parameter, all corners of boxes with up to six parameters, and
/// random places.
std::vector<Values> places_of_box(const PartInfo& info, int n_random) {
    std::vector<Values> places = {defaults(info)};
    for (const PartParameter& parameter : info.parameters) {
        for (const double end : {parameter.min, parameter.max}) {
            places.push_back(defaults(info));
            places.back()[parameter.name] = end;
        }
    }
    const std::size_t n = info.parameters.size();
    for (int corner = 0; n <= 6 && corner < 1 << n; ++corner) {
        places.emplace_back();
        for (std::size_t i = 0; i < n; ++i) {
            const PartParameter& parameter = info.parameters[i];
            places.back()[parameter.name] = (corner >> i) % 2 == 0 ? parameter.min : parameter.max;
        }
    }
    std::mt19937 random(1);
    for (int k = 0; n > 0 && k < n_random; ++k) {
        places.emplace_back();
        for (const PartParameter& parameter : info.parameters) {
            const double part = static_cast<double>(random()) / 4294967295.0;
            places.back()[parameter.name] = parameter.min + part * (parameter.max - parameter.min);
        }
    }
    return places;
}

/// What holds for every member of a family, at every edge length.
SurfaceFigures check_member(const std::string& name, const PartSurface& part) {
    const SurfaceFigures figures = measure(part);
    CHECK(figures.euler_characteristic == 2 - 2 * expected().at(name).genus);
    CHECK(figures.volume > 0.0);
    CHECK(figures.n_wrong_feature_edges == 0);
    CHECK(figures.n_misplaced_edges == 0);
    CHECK(figures.n_regions == static_cast<int>(part.faces.size()));
    CHECK(figures.smallest_at_features > feature_angle);
    CHECK(figures.largest_elsewhere < feature_angle);
    CHECK(figures.smallest_angle > 5.0);
    constexpr double rounding = 1e-10;
    CHECK(figures.largest_bulge < rounding);
    return figures;
}

}  // namespace

TEST_CASE("part surfaces: the expected ones are there, with unique names", "[parts]") {
    CHECK(part_surfaces().size() == expected().size());
    for (const PartInfo& info : part_surfaces()) {
        CAPTURE(info.name);
        CHECK(expected().contains(info.name));
        const PartSurface part = make_part_surface(info.name);
        const std::vector<std::string> names = names_of(part);
        CHECK(std::set<std::string>(names.begin(), names.end()).size() == names.size());
        CHECK(std::count_if(part.faces.begin(), part.faces.end(), [](const PartFace& face) {
                  return face.is_cap;
              }) == expected().at(info.name).n_caps);
        for (const PartFace& face : part.faces) {
            CHECK((!face.is_cap || face.kind == PartFaceKind::plane));
        }
    }
}

TEST_CASE("part surfaces: closed, of the right genus, well shaped and fine enough at the default",
          "[parts]") {
    for (const PartInfo& info : part_surfaces()) {
        CAPTURE(info.name);
        const PartSurface part = make_part_surface(info.name);
        const SurfaceFigures figures = check_member(info.name, part);
        CHECK(figures.n_triangles >= expected().at(info.name).min_triangles);
        CHECK(figures.smallest_angle > 20.0);
        CHECK(figures.part_below_25 < 0.01);
        CHECK(figures.longest_edge < 1.6 * default_edge_length(info.name));
        CHECK(figures.mean_edge > 0.75 * default_edge_length(info.name));
        CHECK_FALSE(intersects_itself(part.soup));
    }
}

TEST_CASE("part surfaces: the smallest members have enough triangles too", "[parts]") {
    const std::map<std::string, Values> smallest = {
        {"pant", {{"X1", 40.0}, {"X2", -40.0}, {"Y3", -40.0}}},
        {"seal",
         {{"R1", 11.0}, {"R2", 20.0}, {"R3", 35.0}, {"H1", 28.0}, {"H2", 10.0}, {"L1", 50.0}}},
        {"half_seal",
         {{"arm_half_width", 11.0},
          {"inner_radius", 20.0},
          {"outer_radius", 35.0},
          {"ring_height", 28.0},
          {"arm_height", 10.0},
          {"arm_length", 50.0}}},
        {"wheel", {{"R5", 80.275}, {"R6", 86.625}, {"H1", 26.0}, {"L1", 43.875}}},
        {"casting",
         {{"radius_B", 120.0}, {"height_B", 15.0}, {"radius_H", 35.0}, {"height_H", 140.0}}}};
    for (const auto& [name, values] : smallest) {
        CAPTURE(name);
        const PartSurface part = make_part_surface(name, values);
        CHECK(static_cast<int>(part.soup.triangles.size()) >= expected().at(name).min_triangles);
    }
}

TEST_CASE("part surfaces: volumes go to the closed forms with the square of the edge length",
          "[parts]") {
    for (const PartInfo& info : part_surfaces()) {
        if (!expected().at(info.name).volume) {
            continue;
        }
        CAPTURE(info.name);
        const double exact = expected().at(info.name).volume(defaults(info));
        std::vector<double> errors;
        for (const double size : {1.0, 0.5}) {
            const SurfaceFigures figures =
                measure(make_part_surface(info.name, {}, size * default_edge_length(info.name)));
            errors.push_back(std::abs(figures.volume / exact - 1.0));
        }
        constexpr double rounding = 1e-12;
        CAPTURE(errors[0], errors[1]);
        CHECK(errors[0] < 0.01);
        // Where the longest edges are set by curvature, both are equally fine there.
        CHECK((errors[1] < rounding || errors[1] < 0.45 * errors[0]));
    }
}

TEST_CASE("part surfaces: valid, with the same names and topology, over the whole box", "[parts]") {
    constexpr double coarse = 3.0;
    constexpr int n_random = 50;
    for (const PartInfo& info : part_surfaces()) {
        // A torus of a thin tube turns too much along longer edges.
        const double length =
            (info.name == "torus" ? 1.0 : coarse) * default_edge_length(info.name);
        const std::vector<std::string> names = names_of(make_part_surface(info.name));
        for (const Values& values : places_of_box(info, n_random)) {
            CAPTURE(info.name, values, length);
            const PartSurface part = make_part_surface(info.name, values, length);
            const SurfaceFigures figures = check_member(info.name, part);
            CHECK(names_of(part) == names);
            CHECK_FALSE(intersects_itself(part.soup));
            if (expected().at(info.name).volume) {
                constexpr double facets = 0.04;
                CHECK(figures.volume ==
                      Approx(expected().at(info.name).volume(values)).epsilon(facets));
            }
        }
    }
}

TEST_CASE("part surfaces: the same bits each time", "[parts]") {
    for (const PartInfo& info : part_surfaces()) {
        CAPTURE(info.name);
        const double length = 2.0 * default_edge_length(info.name);
        const PartSurface a = make_part_surface(info.name, {}, length);
        const PartSurface b = make_part_surface(info.name, {}, length);
        CHECK(a.soup.points == b.soup.points);
        CHECK(a.soup.triangles == b.soup.triangles);
        CHECK(a.face_of_triangle == b.face_of_triangle);
    }
}

TEST_CASE("part surfaces: descriptions name all faces", "[parts]") {
    for (const PartInfo& info : part_surfaces()) {
        // Those of many faces name the pattern.
        if (info.name == "sierpinski" || info.name == "wheel") {
            continue;
        }
        CAPTURE(info.name);
        for (const PartFace& face : make_part_surface(info.name).faces) {
            const std::string name = info.name == "seal" && face.name.starts_with("arm_x_high")
                                         ? "arm_x_high"
                                     : face.name.starts_with("leg_4") ? "leg_4"
                                     : face.name.starts_with("bolt_") ? "bolt_1"
                                                                      : face.name;
            CHECK_THAT(info.description, Contains(name));
        }
    }
}

TEST_CASE("part surfaces: caps lie where the tables put them", "[parts]") {
    const Values values = {{"X1", 40.0},  {"Y1", -40.0}, {"Z1", 35.0},  {"X2", 30.0}, {"Y2", 20.0},
                           {"Z2", -10.0}, {"X3", -40.0}, {"Y3", -40.0}, {"Z3", 5.0}};
    const PartSurface pant = make_part_surface("pant", values, 10.0);
    const std::vector<Vector3> centres = {
        {-70.0, -40.0, 35.0}, {140.0, 20.0, -10.0}, {-40.0, 90.0, 5.0}};
    for (int i = 0; i < 3; ++i) {
        Vector3 low = Vector3::Constant(1e9);
        Vector3 high = -low;
        for (const int v : vertices_of_face(pant, "cap_" + std::to_string(i + 1))) {
            low = low.cwiseMin(pant.soup.points[v]);
            high = high.cwiseMax(pant.soup.points[v]);
        }
        constexpr double rounding = 1e-12;
        CHECK(((low + high) / 2 - centres[i]).norm() < rounding);
        const Vector3 size = i < 2 ? Vector3(0.0, 40.0, 40.0) : Vector3(40.0, 0.0, 40.0);
        CHECK((high - low - size).norm() < rounding);
    }
}

TEST_CASE("part surfaces: vertices lie on the cylinders of their faces", "[parts]") {
    struct Place {
        std::string part;
        std::string face;
        double x = 0.0;
        double radius = 0.0;
    };
    for (const Place& place : std::vector<Place>{{"seal", "inner", 0.0, 25.0},
                                                 {"seal", "outer", 0.0, 40.0},
                                                 {"half_seal", "outer", 0.0, 40.0},
                                                 {"wheel", "bore", 0.0, 8.775},
                                                 {"wheel", "hub", 0.0, 27.625},
                                                 {"wheel", "window_x_low_outer", 0.0, 65.0},
                                                 {"wheel", "rim", 0.0, 89.3},
                                                 {"casting", "bolt_1", 80.5, 12.0},
                                                 {"casting", "hub", 0.0, 37.5}}) {
        const PartSurface part = make_part_surface(place.part);
        CAPTURE(place.part, place.face);
        double largest = 0.0;
        for (const int v : vertices_of_face(part, place.face)) {
            const Vector3& x = part.soup.points[v];
            largest =
                std::max(largest, std::abs(std::hypot(x.x() - place.x, x.y()) - place.radius));
        }
        constexpr double rounding = 1e-12;
        CHECK(largest < rounding);
    }
}

TEST_CASE("part surfaces: a surface with a spline part's name has its parameters and sets",
          "[parts]") {
    for (const PartInfo& surface : part_surfaces()) {
        for (const PartInfo& spline : parts()) {
            if (spline.name != surface.name) {
                continue;
            }
            for (const PartParameter& parameter : surface.parameters) {
                CAPTURE(surface.name, parameter.name);
                const auto same = std::find_if(
                    spline.parameters.begin(), spline.parameters.end(),
                    [&](const PartParameter& other) { return other.name == parameter.name; });
                REQUIRE(same != spline.parameters.end());
                CHECK(same->value == parameter.value);
                CHECK(same->min == parameter.min);
                CHECK(same->max == parameter.max);
            }
            const auto part = std::get<iga::MultiPatch<3>>(make_part(spline.name));
            for (const PartFace& face : make_part_surface(surface.name).faces) {
                CAPTURE(face.name);
                CHECK(part.boundary_sets.contains(face.name));
            }
        }
    }
}

TEST_CASE("part surfaces: errors", "[parts]") {
    CHECK_THROWS_WITH(make_part_surface("whel"),
                      Equals("make_part_surface: unknown part 'whel'; did you mean 'wheel'? there "
                             "are: pant, double_t, double_curved_t, seal, half_seal, wheel, "
                             "casting, plate, plate_with_two_holes, torus, double_torus, cube, "
                             "cylinder, sierpinski"));
    CHECK_THROWS_WITH(default_edge_length("seals"),
                      Contains("default_edge_length: unknown part 'seals'; did you mean 'seal'?"));
    CHECK_THROWS_WITH(
        make_part_surface("plate", {{"P3", 1.0}}),
        Contains("plate: unknown parameter 'P3'; did you mean") && Contains("there are: P1, P2"));
    CHECK_THROWS_WITH(make_part_surface("plate", {{"P1", 51.0}}),
                      Equals("plate: P1 = 51 is out of range; it must lie in [20, 50] (diameter of "
                             "the hole, mm)"));
    CHECK_THROWS_WITH(
        make_part_surface("plate", {{"P1", std::numeric_limits<double>::quiet_NaN()}}),
        Contains("P1 = nan is out of range"));
    CHECK_THROWS_WITH(make_part_surface("plate", {}, 0.1),
                      Equals("plate: target_edge_length = 0.1 is out of range; it must lie in "
                             "[0.2, 1000000] mm, or be 0 for 4 mm"));
    for (const double wrong : {-1.0, std::numeric_limits<double>::quiet_NaN(),
                               std::numeric_limits<double>::infinity()}) {
        CHECK_THROWS_AS(make_part_surface("plate", {}, wrong), InputError);
    }
    CHECK_NOTHROW(make_part_surface("cube", {}, 1e6));
}

}  // namespace couture::meshing
