#include "io/spline_info.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "iga/topology/element_quality.h"
#include "tests/data_folder.h"
#include "tests/io/sample_splines.h"

using namespace couture;
using Catch::Matchers::Contains;
using Json = nlohmann::json;

namespace {

io::SplineFile sample() {
    iga::MultiPatch<3> pair = test::make_pair<3>(0, 0, true);
    return {pair, "G+Smo XML", {"a note"}};
}

Json info_of(const io::SplineFile& file) { return Json::parse(io::spline_info_json(file)); }

/// Numbers of the patches for which `key` holds `value`.
std::vector<int> patches_with(const Json& info, const char* key, const Json& value) {
    std::vector<int> result;
    for (std::size_t i = 0; i < info["patches"].size(); ++i) {
        if (info["patches"][i][key] == value) {
            result.push_back(static_cast<int>(i));
        }
    }
    return result;
}

Json info_of_public(const std::filesystem::path& folder, const std::string& name) {
    return info_of(io::read_splines(folder / "volumes" / name));
}

struct Handedness {
    const char* file;
    std::vector<int> left_handed;
};

}  // namespace

TEST_CASE("spline_info_json: holds what the multipatch holds", "[io]") {
    const io::SplineFile file = sample();
    const auto& pair = std::get<iga::MultiPatch<3>>(file.multipatch);
    const Json info = info_of(file);
    CHECK(info["format"] == "G+Smo XML");
    CHECK(info["notes"] == Json({"a note"}));
    CHECK(info["n_parameters"] == 3);
    CHECK(info["dimension"] == 3);
    CHECK(info["n_control_points"] == pair.n_control_points());
    REQUIRE(info["patches"].size() == 2);
    const Json& first = info["patches"][0];
    CHECK(first["degrees"] == Json({2, 1, 3}));
    CHECK(first["elements"] == Json({2, 2, 1}));
    CHECK(first["control_points"] == Json({4, 3, 4}));
    CHECK(first["knots"].size() == 3);
    CHECK(first["knots"][0].get<std::vector<double>>() == pair.patches[0].knots(0).knots());
    CHECK(first["rational"] == true);
    CHECK(first["validity"] == "valid");
    CHECK(first["left_handed"] == false);
    CHECK(first["min_jacobian"] > 0.5);
    CHECK(first["min_scaled_jacobian"] > 0.9);
    const iga::QualitySummary<3> quality = iga::element_quality(pair);
    CHECK(info["max_shape_ratio"] == quality.max_shape_ratio);
    CHECK(info["mean_shape_ratio"] == quality.mean_shape_ratio);
    CHECK(info["worst_shape_ratio_patch"] == quality.worst_shape_ratio_patch);
    CHECK(info["worst_shape_ratio_at"][0] == quality.worst_shape_ratio_xi[0]);
    CHECK(info["max_angle_deviation"] == quality.max_angle_deviation);
    CHECK(info["mean_angle_deviation"] == quality.mean_angle_deviation);
    CHECK(info["n_interfaces"] == 1);
    CHECK(info["interfaces"] == Json({"patch 0 side 0:high and patch 1 side 0:low"}));
    CHECK(info["n_outer_sides"] == 10);
    CHECK(info["boundary_sets"]["boundary_3"] == Json({"patch 0 side 0:low"}));
    CHECK(info["boundary_sets"]["clamped"] == Json({"patch 0 side 1:low", "patch 1 side 0:high"}));
    CHECK(info["volume"] == iga::volume(pair));
    CHECK(info["bounding_box"]["low"][0] == pair.bounding_box()(0, 0));
    CHECK(info["bounding_box"]["high"][2] == pair.bounding_box()(2, 1));
    CHECK(info["signature"] == iga::signature(pair));
}

TEST_CASE("spline_info_text: says the same in lines", "[io]") {
    const std::string text = io::spline_info_text(sample());
    CHECK_THAT(text, Catch::StartsWith("G+Smo XML: 2 patches, 1 interface, 10 outer sides\n"
                                       "  patch 0: degrees 2, 1, 3, elements 2 x 2 x 1, control "
                                       "points 4 x 3 x 4, rational; valid, smallest Jacobian "));
    CHECK_THAT(text, Contains("  interface: patch 0 side 0:high and patch 1 side 0:low\n"));
    CHECK_THAT(text, Contains("boundary set 'boundary_3': patch 0 side 0:low\n"));
    CHECK_THAT(text, Contains("\ncontrol points: 96\nbounding box: ("));
    CHECK_THAT(text, Contains("\nvolume: "));
    CHECK_THAT(text, Contains("\nscaled Jacobian: smallest 0."));
    CHECK_THAT(text,
               Contains("\nshape ratio: largest ") && Contains("\nangle deviation: largest "));
    CHECK_THAT(text, Contains("\nsignature: "));
    CHECK_THAT(text, Catch::EndsWith("\nnote: a note\n"));
    CHECK_THAT(text, !Contains("folded"));
    CHECK_THAT(text, !Contains("left-handed"));
}

TEST_CASE("spline_info_text: lists folded and left-handed patches", "[io]") {
    io::SplineFile file = sample();
    auto& pair = std::get<iga::MultiPatch<3>>(file.multipatch);
    pair.interfaces.clear();
    MatrixX mirrored = pair.patches[0].control_points();
    mirrored.col(1) *= -1.0;
    pair.patches[0] = {pair.patches[0].space(), mirrored, pair.patches[0].weights()};
    // A corner pulled through the patch.
    MatrixX folded = pair.patches[1].control_points();
    folded(0, 0) += 5.0;
    pair.patches[1] = {pair.patches[1].space(), folded, pair.patches[1].weights()};
    const std::string text = io::spline_info_text(file);
    CHECK_THAT(text, Contains("valid, left-handed, smallest Jacobian "));
    CHECK_THAT(text, Contains("\nfolded: patch 1\nleft-handed: patch 0\n"));
    CHECK(info_of(file)["patches"][1]["min_scaled_jacobian"] < 0.0);
}

TEST_CASE("spline_info: surfaces in space have an area and no Jacobian", "[io]") {
    MatrixX corners(4, 3);
    corners << 0, 0, 0, 3, 0, 0, 0, 0, 2, 3, 0, 2;
    iga::MultiPatch<2> shell;
    shell.patches = {{{{iga::KnotVector::uniform(1, 1), iga::KnotVector::uniform(1, 1)}}, corners}};
    const io::SplineFile file{shell, "GeoPDEs text", {}};
    const Json info = info_of(file);
    CHECK(info["n_parameters"] == 2);
    CHECK(info["dimension"] == 3);
    CHECK_FALSE(info.contains("min_scaled_jacobian"));
    CHECK_FALSE(info["patches"][0].contains("validity"));
    const std::string text = io::spline_info_text(file);
    CHECK_THAT(text, Contains("GeoPDEs text: 1 patch, 0 interfaces, 4 outer sides\n"
                              "  patch 0: degrees 1, 1, elements 1 x 1, control points 2 x 2\n"));
    CHECK_THAT(text, Contains("\narea: 6\n"));
}

TEST_CASE("spline_info_json: names that are not UTF-8 still make JSON", "[io]") {
    io::SplineFile file = sample();
    std::get<iga::MultiPatch<3>>(file.multipatch)
        .boundary_sets
            ["fl\xE4"
             "che"] = {iga::make_side<3>(0, 2)};
    CHECK_NOTHROW(info_of(file));
    CHECK_NOTHROW(io::spline_info_text(file));
}

TEST_CASE("spline_info: left-handed patches of public volumes", "[io]") {
    const auto folder = test::data_folder();
    if (!folder) {
        return;
    }
    const std::vector<Handedness> volumes = {
        {"gismo_GshapedVolume.xml", {0}},      {"gismo_cylinder.xml", {0}},
        {"gismo_fichera.xml", {3, 4, 5, 6}},   {"gismo_twisted_fichera.xml", {}},
        {"geopdes_geo_2cubesa.txt", {}},       {"geopdes_geo_2cubesb.txt", {1}},
        {"geopdes_geo_2cubesc.txt", {}},       {"geopdes_geo_2cubesd.txt", {1}},
        {"geopdes_geo_2cubese.txt", {}},       {"geopdes_geo_2cubesf.txt", {1}},
        {"geopdes_geo_2cubesg.txt", {}},       {"geopdes_geo_2cubesh.txt", {1}},
        {"geopdes_geo_sphere.txt", {0, 1, 2}}, {"gsElasticity_bicepsLeftMP.xml", {}},
        {"mfem_pipe-nurbs.mesh", {}},          {"mfem_ball-nurbs.mesh", {}},
        {"mfem_two-cubes-nurbs-rot.mesh", {}}, {"yeti_volumetricBeam.inp", {}},
    };
    for (const Handedness& volume : volumes) {
        INFO(volume.file);
        const Json info = info_of_public(*folder, volume.file);
        CHECK(patches_with(info, "left_handed", true) == volume.left_handed);
        CHECK(patches_with(info, "validity", "folded").empty());
        CHECK(info["min_scaled_jacobian"] >= 0.0);
    }
}

TEST_CASE("spline_info: collapsed volumes are degenerate, their scaled Jacobian is zero there",
          "[io]") {
    const auto folder = test::data_folder();
    if (!folder) {
        return;
    }
    // Double control points at the bends of the G; a disc whose square has corners of 180 degrees.
    for (const char* name : {"gismo_GshapedVolume.xml", "yeti_elephantTrunk.inp"}) {
        INFO(name);
        const Json info = info_of_public(*folder, name);
        CHECK(info["patches"][0]["validity"] == "degenerate");
        CHECK(std::abs(info["patches"][0]["min_scaled_jacobian"].get<double>()) < 1e-12);
    }
}

TEST_CASE("spline_info: two patches of a public volume are folded at a corner", "[io]") {
    const auto folder = test::data_folder();
    if (!folder) {
        return;
    }
    const io::SplineFile file = io::read_splines(*folder / "volumes" / "gsElasticity_terrific.xml");
    const Json info = info_of(file);
    CHECK(info["patches"].size() == 15);
    CHECK(info["n_interfaces"] == 24);
    // The sixth and the ninth.
    REQUIRE(patches_with(info, "validity", "folded") == std::vector<int>{5, 8});
    CHECK(info["patches"][5]["min_scaled_jacobian"] == Approx(-0.02).margin(0.005));
    CHECK(info["patches"][8]["min_scaled_jacobian"] == Approx(-0.06).margin(0.005));
    CHECK(info["patches"][5]["min_jacobian"] < 0.0);
    CHECK(info["worst_patch"] == 8);
    CHECK_THAT(io::spline_info_text(file), Contains("\nfolded: patch 5, patch 8\n"));
}

TEST_CASE("spline_info: an infinite shape ratio is null and said in words", "[io]") {
    // One side of the box has no area.
    MatrixX wedge(8, 3);
    wedge << 0, 0, 0, 1, 0, 0, 0, 0, 0, 1, 1, 0, 0, 0, 1, 1, 0, 1, 0, 0, 1, 1, 1, 1;
    const iga::KnotVector knots = iga::KnotVector::uniform(1, 1);
    iga::MultiPatch<3> volume;
    volume.patches = {{{{knots, knots, knots}}, wedge}};
    const io::SplineFile file{volume, "GeoPDEs text", {}};
    CHECK(info_of(file)["max_shape_ratio"].is_null());
    CHECK_THAT(io::spline_info_text(file),
               Contains("\nshape ratio: largest infinite (patch 0 at (0.5, 0.5, 0.5)), mean "
                        "infinite\nangle deviation: largest "));
}
