// What the commands say of surfaces that are not as they should be.
#include "drivers/surface_input.h"

#include <array>
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "io/atomic_file.h"
#include "tests/drivers/run_program.h"

using namespace couture;
using namespace couture::tests;
using Catch::Matchers::Contains;

namespace {

const std::string cube_points = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n";

/// Six quads on the points from `first` on, outwards or inwards.
std::string cube_faces(int first, bool is_inwards = false) {
    std::string text;
    for (const std::array<int, 4>& q : {std::array{0, 3, 2, 1},
                                        {4, 5, 6, 7},
                                        {0, 1, 5, 4},
                                        {1, 2, 6, 5},
                                        {2, 3, 7, 6},
                                        {3, 0, 4, 7}}) {
        text += "4";
        for (int k = 0; k < 4; ++k) {
            text += " " + std::to_string(first + q[is_inwards ? 3 - k : k]);
        }
        text += "\n";
    }
    return text;
}

std::string moved_points(double factor, double shift) {
    std::string text;
    for (int i = 0; i < 8; ++i) {
        const bool x = i % 4 == 1 || i % 4 == 2;
        const bool y = i % 4 >= 2;
        for (const bool on : {x, y, i >= 4}) {
            text += std::to_string((on ? factor : 0.0) + shift) + " ";
        }
        text += "\n";
    }
    return text;
}

std::string two_cubes(double factor, double shift, bool is_inwards = false) {
    return "OFF\n16 12 0\n" + cube_points + moved_points(factor, shift) + cube_faces(0) +
           cube_faces(8, is_inwards);
}

const std::string fan =
    "OFF\n5 3 0\n0 0 0\n1 0 0\n0 1 0\n0 -1 0\n0 0 1\n3 0 1 2\n3 0 3 1\n3 0 1 4\n";
const std::string moebius =
    "OFF\n6 6 0\n1 0 0\n0 1 0\n-1 0 0\n0 -1 0.5\n0 0 1\n0.5 0.5 -1\n3 0 1 2\n3 1 3 2\n3 2 3 4\n"
    "3 3 5 4\n3 4 5 1\n3 5 0 1\n";

}  // namespace

TEST_CASE("mesh: surfaces that bound no solid are refused, with a file that marks the places",
          "[drivers]") {
    const TemporaryFolder folder;
    const auto refused = [&](const std::string& text, const std::string& message) {
        io::write_text(folder.path() / "bad.off", text);
        std::filesystem::remove(folder.path() / "out/bad/bad_problems.vtp");
        const auto result = run_couture("mesh bad.off --stage surface", folder.path());
        CHECK(result.exit_code == 2);
        CHECK_THAT(result.errors, Contains(message) && Contains("bad_problems.vtp"));
        CHECK(std::filesystem::exists(folder.path() / "out/bad/bad_problems.vtp"));
    };
    refused(fan,
            "non-manifold edge at (0.5, 0, 0): edge of vertices 0 and 1 with 3 triangles: 0, 1, 2");
    refused(two_cubes(0.5, 1.0), "non-manifold vertex at (1, 1, 1): vertex 6 where 2 fans");
    refused(two_cubes(0.5, 3.0), "disjoint shell at (3.25, 3.25, 3.25): shell 1 outside shell 0");
    refused(two_cubes(0.5, 3.0), "--shell N");
    refused(two_cubes(1.0, 0.55), "self-intersection (");
    refused("OFF\n4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n",
            "2 triangles; the least solid, a tetrahedron, has 4");
    refused(moebius, "inconsistent edge");
}

TEST_CASE("mesh: what can be told apart is repaired and said", "[drivers]") {
    const TemporaryFolder folder;
    const auto taken = [&](const std::string& text, const std::string& options,
                           const std::string& message) {
        io::write_text(folder.path() / "good.off", text);
        const auto result =
            run_couture("mesh good.off --stage surface --json " + options, folder.path());
        CAPTURE(result.errors);
        CHECK(result.exit_code == 0);
        CHECK_THAT(result.errors, Contains(message));
        return nlohmann::json::parse(result.output.empty() ? "{}" : result.output);
    };
    const std::string cube = "OFF\n8 6 0\n" + cube_points;
    taken(cube + cube_faces(0, true), "", "inside out; it is turned round");
    std::string mixed = cube_faces(0);
    mixed.replace(0, 9, "4 1 2 3 0");
    const auto turned = taken(cube + mixed, "", "2 triangles ran against their neighbours");
    CHECK(turned["surface"]["volume"].get<double>() == Approx(1.0));
    // A cavity is legal, whichever way it turns.
    const auto hollow = taken(two_cubes(0.5, 0.2), "", "inside out");
    CHECK(hollow["surface"]["volume"].get<double>() == Approx(1.0 - 0.125));
    // One shell of it: the outer one keeps its cavity, the wall of the cavity is a body.
    CHECK(taken(two_cubes(0.5, 0.2), "--shell 0", "")["surface"]["volume"].get<double>() ==
          Approx(1.0 - 0.125));
    CHECK(taken(two_cubes(0.5, 0.2, true), "--shell 1",
                "shell 1 is the wall of a cavity")["surface"]["volume"]
              .get<double>() == Approx(0.125));
    CHECK(taken(two_cubes(0.5, 3.0), "--shell 1", "")["surface"]["volume"].get<double>() ==
          Approx(0.125));
    std::string open = "OFF\n8 5 0\n" + cube_points + cube_faces(0);
    open = open.substr(0, open.rfind("4 3 0"));
    CHECK(taken(open, "", "")["surface"]["boundaries"] == 1);
    CHECK(taken(open, "--fill-holes", "")["surface"]["boundaries"] == 0);
    const auto parted = run_couture("info good.off --json", folder.path());
    CHECK(nlohmann::json::parse(parted.output)["problems"].size() == 1);
}

TEST_CASE("info: surfaces and parts are described, with problems too", "[drivers]") {
    const TemporaryFolder folder;
    for (const std::string& text :
         {fan, moebius, two_cubes(0.5, 3.0), two_cubes(1.0, 0.55), two_cubes(0.5, 1.0)}) {
        io::write_text(folder.path() / "bad.off", text);
        const auto info = run_couture("info bad.off --json", folder.path());
        CHECK(info.exit_code == 0);
        CHECK(nlohmann::json::parse(info.output)["problems"].size() > 0);
    }
    const auto part = run_couture("info plate_with_two_holes", folder.path());
    CHECK(part.exit_code == 0);
    CHECK_THAT(part.output, Contains("problems: none") && Contains("genus 2"));
    // Corners, by names that decks can use, with their places.
    const auto plate = run_couture("info plate", folder.path());
    CHECK_THAT(plate.output, Contains("corner x_high-y_high-z_high: (50, 200, 10)\n"));
    const auto corners =
        nlohmann::json::parse(run_couture("info plate --json", folder.path()).output)["corners"];
    CHECK(corners.size() == 8);
    CHECK(corners["x_high-y_high-z_high"] == nlohmann::json({50.0, 200.0, 10.0}));
    CHECK(corners["x_low-y_low-z_low"] == nlohmann::json({-50.0, 0.0, 0.0}));
    const auto touching = run_couture("info bad.off --fix", folder.path());
    CHECK_THAT(touching.output, Contains("1 vertex copied where parts touched at it"));
    const auto refused = run_couture("mesh bad.off --fix --stage surface", folder.path());
    CHECK(refused.exit_code == 2);
    CHECK_THAT(refused.errors, Contains("--fix gave parts that touch a vertex each, but they still "
                                        "lie in one place") &&
                                   Contains("--shell N"));
    io::write_text(folder.path() / "a.step", "x");
    const auto unknown = run_couture("info a.step", folder.path());
    CHECK(unknown.exit_code == 2);
    CHECK_THAT(unknown.errors, Contains(".xml") && Contains(".vtp"));
    CHECK(run_couture("info none.ply", folder.path()).exit_code == 2);
}

TEST_CASE("parts: their names come before folders and files", "[drivers]") {
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder.path() / "plate");
    io::write_text(folder.path() / "cube", "no surface");
    for (const std::string command : {"info plate", "info cube", "mesh cube --stage surface"}) {
        CAPTURE(command);
        CHECK(run_couture(command, folder.path()).exit_code == 0);
    }
    CHECK_THAT(run_couture("info ./cube", folder.path()).errors, Contains("./cube"));
}

TEST_CASE("convert: surfaces to all formats, not to splines", "[drivers]") {
    const TemporaryFolder folder;
    for (const std::string ending : {"stl", "obj", "off", "ply", "vtp"}) {
        CHECK(run_couture("convert plate --edge-length 8 a." + ending, folder.path()).exit_code ==
              0);
        const auto info = run_couture("info --json a." + ending, folder.path());
        CHECK(nlohmann::json::parse(info.output)["problems"].empty());
    }
    const auto refused = run_couture("convert a.stl a.xml", folder.path());
    CHECK(refused.exit_code == 2);
    CHECK_THAT(refused.errors, Contains("a.stl is a surface of triangles") &&
                                   Contains("splines have to be fitted to it"));
    io::write_text(folder.path() / "a.xml", "<xml/>");
    CHECK_THAT(run_couture("convert a.xml b.stl", folder.path()).errors,
               Contains("a.xml is a spline file or deck"));
    CHECK_THAT(run_couture("convert a.off a.off", folder.path()).errors,
               Contains("would replace its own input"));
    io::write_text(folder.path() / "hollow.off", two_cubes(0.5, 0.2, true));
    CHECK_THAT(run_couture("convert hollow.off b.off --shell 1", folder.path()).errors,
               Contains("shell 1 is the wall of a cavity"));
    CHECK_THAT(run_couture("convert a.stl b.stl --set P1=3", folder.path()).errors,
               Contains("--set and --edge-length are for parts"));
}
