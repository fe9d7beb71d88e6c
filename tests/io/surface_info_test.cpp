#include "io/surface_info.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

using namespace couture;
using Catch::Matchers::Contains;

namespace {

io::DescribedSurface describe(const meshing::TriangleSoup& soup) {
    io::DescribedSurface surface;
    surface.name = "a.off";
    surface.file.format = "OFF";
    surface.soup = soup;
    surface.check = meshing::check_solid(soup);
    return surface;
}

const meshing::TriangleSoup tetrahedron{.points = {{0, 0, 0}, {3, 0, 0}, {0, 4, 0}, {0, 0, 12}},
                                        .triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};

}  // namespace

TEST_CASE("surface_info: a tetrahedron in numbers", "[io]") {
    const auto info = nlohmann::json::parse(io::surface_info_json(describe(tetrahedron)));
    CHECK(info["points"] == 4);
    CHECK(info["edges"] == 6);
    CHECK(info["euler_characteristic"] == 2);
    CHECK(info["closed"] == true);
    CHECK(info["genus"] == 0);
    CHECK(info["volume"].get<double>() == Approx(3.0 * 4.0 * 12.0 / 6.0));
    CHECK(info["shortest_edge"] == 3.0);
    CHECK(info["longest_edge"].get<double>() == Approx(std::sqrt(160.0)));
    CHECK(info["features"]["sharp_edges"] == 6);
    CHECK(info["solid"]["betti"] == std::array{1, 0, 0});
    CHECK(info["problems"].empty());
    const std::string text = io::surface_info_text(describe(tetrahedron));
    CHECK_THAT(text,
               Contains("closed, manifold, oriented") && Contains("sphere (genus 0") &&
                   Contains("volume: 24\n") && Contains("problems: none") &&
                   Contains("6 sharp edges at 40 degrees, 6 curves, 4 corners, 4 smooth faces"));
}

TEST_CASE("surface_info: problems are told, not refused", "[io]") {
    meshing::TriangleSoup soup = tetrahedron;
    soup.triangles.resize(2);
    const auto info = nlohmann::json::parse(io::surface_info_json(describe(soup)));
    CHECK(info["closed"] == false);
    CHECK(info["volume"].is_null());
    CHECK(info["solid"].is_null());
    REQUIRE(info["problems"].size() == 2);
    CHECK(info["problems"][0]["kind"] == "open boundary");
    CHECK_THAT(io::surface_info_text(describe(soup)),
               Contains("1 surface of too few triangles:") && Contains("loop of 4 edges"));
    soup.triangles = {{0, 1, 2}, {0, 1, 3}, {1, 0, 2}};
    const std::string text = io::surface_info_text(describe(soup));
    CHECK_THAT(text, Contains("not a manifold") && Contains("duplicate triangle"));
}
