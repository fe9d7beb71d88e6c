#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "io/atomic_file.h"
#include "tests/drivers/run_program.h"

using namespace couture;
using namespace couture::tests;
using Catch::Matchers::Contains;

TEST_CASE("mesh: a part is cut into pants and every stage is written", "[drivers]") {
    const TemporaryFolder folder;
    const auto result = run_couture("mesh plate_with_two_holes --json --out here", folder.path());
    REQUIRE(result.exit_code == 0);
    const auto object = nlohmann::json::parse(result.output);
    CHECK(object["surface"]["genus"] == 2);
    CHECK(object["surface"]["euler_characteristic"] == -2);
    CHECK(object["features"]["faces"] == 8);
    CHECK(object["patches"].size() == 2);
    CHECK(object["curves"].size() == 3);
    CHECK(object["files"].size() == 5);
    for (const auto& file : object["files"]) {
        CHECK(std::filesystem::exists(folder.path() / file.get<std::string>()));
    }
    const auto again = run_couture("mesh plate_with_two_holes --out there", folder.path());
    REQUIRE(again.exit_code == 0);
    // The same bits but for the provenance, which is the same command here.
    CHECK(io::read_text(folder.path() / "here/plate_with_two_holes_pants.vtp") ==
          io::read_text(folder.path() / "there/plate_with_two_holes_pants.vtp"));
}

TEST_CASE("mesh: stages, dimensions and weights can be chosen", "[drivers]") {
    const TemporaryFolder folder;
    const auto surface =
        run_couture("mesh plate --set P1=25 --edge-length 8 --stage surface --json", folder.path());
    REQUIRE(surface.exit_code == 0);
    CHECK(nlohmann::json::parse(surface.output)["files"].size() == 1);
    const auto loops = run_couture("mesh plate_with_two_holes --stage loops --json", folder.path());
    REQUIRE(loops.exit_code == 0);
    const auto object = nlohmann::json::parse(loops.output);
    CHECK(object["curves"].size() == 2);
    CHECK(object["tunnels"].size() == 2);
    CHECK(object["patches"].empty());
    const auto weights = run_couture(
        "mesh plate_with_two_holes --edge-length 8 --cycle length=1 --cycle symmetry=4 --merge "
        "length=1",
        folder.path());
    CHECK(weights.exit_code == 0);
    CHECK_THAT(weights.output, Contains("2 pants"));
}

TEST_CASE("mesh: another member of a family is cut as the first one was", "[drivers]") {
    const TemporaryFolder folder;
    const auto first =
        run_couture("mesh seal --open caps --edge-length 4 --out first", folder.path());
    REQUIRE(first.exit_code == 0);
    CHECK_THAT(first.output, Contains("cap cap_x_low"));
    const auto second = run_couture(
        "mesh seal --set L1=79 --set R3=43 --edge-length 3.5 --like first/seal_pants.json "
        "--json --out second",
        folder.path());
    REQUIRE(second.exit_code == 0);
    const auto reference = nlohmann::json::parse(
        run_couture("mesh seal --open caps --edge-length 4 --json", folder.path()).output);
    const auto member = nlohmann::json::parse(second.output);
    CHECK(member["patches"] == reference["patches"]);
    CHECK(std::filesystem::exists(folder.path() / "second/seal_pants.json"));
    REQUIRE(run_couture("convert seal --edge-length 4 seal.off", folder.path()).exit_code == 0);
    const auto closed = run_couture("mesh seal.off --like first/seal_pants.json", folder.path());
    CHECK(closed.exit_code == 2);
    CHECK_THAT(closed.errors, Contains("open the same caps") && Contains("cap_x_low"));
}

TEST_CASE("mesh: a deck says all of it", "[drivers]") {
    const TemporaryFolder folder;
    io::write_text(folder.path() / "plate.toml",
                   "[geometry]\npart = \"plate_with_two_holes\"\n[meshing]\nedge_length = "
                   "8\n[[meshing.cycle_through]]\npoints = [[0, 0, 0]]\n");
    const auto checked = run_couture("check plate.toml", folder.path());
    CHECK(checked.exit_code == 0);
    CHECK_THAT(checked.output, Contains("valid"));
    CHECK_THAT(run_couture("check plate.toml --json", folder.path()).output,
               Contains("\"status\": \"valid\""));
    const auto solved = run_couture("solve plate.toml", folder.path());
    CHECK(solved.exit_code == 2);
    CHECK_THAT(solved.errors, Contains("[meshing] is for `couture mesh`"));
    const auto stage = run_couture("mesh plate.toml --stage features --json", folder.path());
    REQUIRE(stage.exit_code == 0);
    CHECK(nlohmann::json::parse(stage.output)["files"].size() == 2);
    const auto both = run_couture("mesh plate.toml --edge-length 8", folder.path());
    CHECK(both.exit_code == 2);
    CHECK_THAT(both.errors, Contains("a deck says itself how it is meshed"));
    const auto changed = run_couture("mesh plate.toml --set meshing.edge_length=-8", folder.path());
    CHECK(changed.exit_code == 2);
    CHECK_THAT(changed.errors, Contains("edge_length"));
}

TEST_CASE("mesh: dimensions and points of a part are in the unit of the deck", "[drivers]") {
    const TemporaryFolder folder;
    const auto volume = [&](const std::string& text) {
        io::write_text(folder.path() / "plate.toml", text);
        const auto result = run_couture("mesh plate.toml --stage surface --json", folder.path());
        CAPTURE(result.errors);
        REQUIRE(result.exit_code == 0);
        return nlohmann::json::parse(result.output)["surface"]["volume"].get<double>();
    };
    const std::string geometry = "[geometry]\npart = \"plate\"\n[geometry.parameters]\nP1 = ";
    const double in_mm = volume(geometry + "30\n[meshing]\nedge_length = 8\n");
    const std::string metres = "[units]\nsystem = \"m N Pa\"\n";
    constexpr double cubic_millimetre = 1e-9;
    CHECK(volume(metres + geometry + "0.03\n[meshing]\nedge_length = 0.008\n") ==
          Approx(in_mm * cubic_millimetre));
    CHECK(volume(metres + geometry + "\"30 mm\"\n[meshing]\nedge_length = \"8 mm\"\n") ==
          Approx(in_mm * cubic_millimetre));
}

TEST_CASE("check: loops, points and caps that a deck names are tried", "[drivers]") {
    const TemporaryFolder folder;
    const auto refused = [&](const std::string& meshing, const std::string& text) {
        io::write_text(
            folder.path() / "part.toml",
            "[geometry]\npart = \"plate_with_two_holes\"\n[meshing]\nedge_length = 8\n" + meshing);
        const auto result = run_couture("check part.toml", folder.path());
        CHECK(result.exit_code == 2);
        CHECK_THAT(result.errors, Contains(text));
        CHECK_FALSE(std::filesystem::exists(folder.path() / "out"));
    };
    refused("[[meshing.loop]]\npoints = [[0, 0, 500], [10, 0, 500], [0, 10, 500]]\n", "point 0 at");
    refused("[[meshing.cycle_through]]\npoints = [[0, 0, 500]]\n", "away from the surface");
    refused("open = \"lid\"\n", "has no face 'lid'");
    io::write_text(folder.path() / "fan.off",
                   "OFF\n5 3 0\n0 0 0\n1 0 0\n0 1 0\n0 -1 0\n0 0 1\n3 0 1 2\n3 0 3 1\n3 0 1 4\n");
    io::write_text(folder.path() / "fan.toml", "[geometry]\nsurface = \"fan.off\"\n");
    CHECK_THAT(run_couture("check fan.toml", folder.path()).errors,
               Contains("non-manifold edge") && !Contains("problems.vtp"));
    CHECK_FALSE(std::filesystem::exists(folder.path() / "out"));
}

TEST_CASE("mesh: mistakes are explained", "[drivers]") {
    const TemporaryFolder folder;
    const auto refused = [&](const std::string& arguments, const std::string& text) {
        const auto result = run_couture("mesh " + arguments, folder.path());
        CHECK(result.exit_code == 2);
        CHECK_THAT(result.errors, Contains(text));
    };
    refused("plate --stage pant", "did you mean 'pants'?");
    refused("wheal", "there is no file and no part 'wheal'; did you mean 'wheel'?");
    refused("--set P1=25 plate --stage pant", "did you mean 'pants'?");
    refused("plate --set P1", "write NAME=NUMBER");
    refused("plate --set P9=3", "unknown parameter 'P9'");
    refused("plate --cycle weight=3", "has no term 'weight'");
    io::write_text(folder.path() / "text.json", "{}\n");
    refused("plate --fix", "has nothing to repair");
    refused("plate --open lid", "has no face 'lid'");
    refused("plate --open caps", "has no caps");
    refused("plate --open-at 1,2", "write X,Y,Z");
    refused("plate --open-at 1,2,x", "write X,Y,Z");
    refused("plate --open-facing 1,1,1", "no plane face");
    refused("plate --most-boundaries 7", "most_boundaries = 7");
    refused("plate --like no.json", "no.json");
    refused("plate --like text.json --merge length=1", "have no place beside it");
    refused("no_such.stl", "no_such.stl");
    refused("plate --feature-angle 270", "angle");
    io::write_text(folder.path() / "text.stl", "a letter to a friend\n");
    refused("text.stl", "text.stl");
    io::write_text(folder.path() / "fan.off",
                   "OFF\n5 3 0\n0 0 0\n1 0 0\n0 1 0\n0 -1 0\n0 0 1\n3 0 1 2\n3 0 3 1\n3 0 1 4\n");
    refused("fan.off --open caps", "non-manifold edge");
    io::write_text(folder.path() / "bar.toml",
                   "[geometry]\npart = \"box\"\n[material.steel]\nyoungs_modulus = 1\n");
    refused("bar.toml", "a deck for 'couture solve'");
    refused("casting --open caps", "name plane faces of");
    refused("seal --feature-angle 179 --open caps", "take a smaller feature angle");
    std::filesystem::create_symlink("ring.off", folder.path() / "ring.off");
    refused("ring.off", "ring.off");
    REQUIRE(::mkfifo((folder.path() / "pipe.off").c_str(), 0600) == 0);
    refused("pipe.off", "is a pipe or device");
    refused("fan.off", "with 3 triangles: 0, 1, 2");
    refused("fan.off --edge-length 3", "are for parts");
    io::write_text(folder.path() / "inside_out.off",
                   "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 1 2\n3 0 3 1\n3 1 3 2\n3 2 3 0\n");
    const auto turned = run_couture("mesh inside_out.off", folder.path());
    CHECK(turned.exit_code == 0);
    CHECK_THAT(turned.errors, Contains("inside out"));
}

TEST_CASE("mesh: what the volume lacks is said", "[drivers]") {
    const tests::TemporaryFolder folder;
    io::write_text(folder.path() / "one.toml", R"([nodes]
a = "x_low-y_low-z_low"
b = "x_high-y_low-z_low"
c = "x_low-y_high-z_low"
d = "x_high-y_high-z_low"
e = "x_low-y_low-z_high"
f = "x_high-y_low-z_high"
g = "x_low-y_high-z_high"
h = "x_high-y_high-z_high"
[[cuboid]]
nodes = ["a", "b", "c", "d", "e", "f", "g", "h"]
)");
    const auto fine = tests::run_couture(
        "mesh cube --layout one.toml --stage volume --element-size 50", folder.path());
    CHECK(fine.exit_code == 0);
    CHECK_THAT(fine.errors, !Contains("no side of a cuboid") && !Contains("away from the surface"));
}

TEST_CASE("mesh: faces that a layout leaves out and a distance far too large are said",
          "[drivers]") {
    const tests::TemporaryFolder folder;
    // A tall and a low step: one cuboid on the outer corners, none at the step.
    io::write_text(folder.path() / "step.off", R"(OFF
12 20 0
0 0 0
60 0 0
60 30 0
30 30 0
30 60 0
0 60 0
0 0 20
60 0 20
60 30 20
30 30 20
30 60 20
0 60 20
3 0 3 1
3 1 3 2
3 0 5 3
3 3 5 4
3 6 7 9
3 7 8 9
3 6 9 11
3 9 10 11
3 0 1 7
3 0 7 6
3 1 2 8
3 1 8 7
3 2 3 9
3 2 9 8
3 3 4 10
3 3 10 9
3 4 5 11
3 4 11 10
3 5 0 6
3 5 6 11
)");
    io::write_text(folder.path() / "one.toml", R"([nodes]
a = [0, 0, 0]
b = [60, 0, 0]
c = [0, 60, 0]
d = [60, 30, 0]
e = [0, 0, 20]
f = [60, 0, 20]
g = [0, 60, 20]
h = [60, 30, 20]
[[cuboid]]
nodes = ["a", "b", "c", "d", "e", "f", "g", "h"]
)");
    const auto result = tests::run_couture(
        "mesh step.off --layout one.toml --stage volume --element-size 8", folder.path());
    CAPTURE(result.errors);
    CHECK_THAT(result.errors, Contains("no side of a cuboid lies on the faces"));
    CHECK_THAT(result.errors, Contains("away from the surface: smaller elements"));
}

TEST_CASE("mesh: a run that fails leaves the stages before", "[drivers]") {
    const tests::TemporaryFolder folder;
    const auto result = tests::run_couture("mesh double_t --stage volume --out o", folder.path());
    CHECK(result.exit_code == 2);
    CHECK_THAT(result.errors,
               Contains("no template fits") && Contains("it came as far as stage pants"));
    CHECK(std::filesystem::exists(folder.path() / "o/double_t_pants.vtp"));
}

TEST_CASE("mesh: numbers that no run could end with are refused at once", "[drivers]") {
    const tests::TemporaryFolder folder;
    const auto refused = [&](const std::string& options, const std::string& why) {
        const auto result = tests::run_couture("mesh cube " + options, folder.path());
        CAPTURE(options, result.errors);
        CHECK(result.exit_code == 2);
        CHECK_THAT(result.errors, Contains(why));
    };
    refused("--stage volume --element-size 1e-9", "at most 2e+06 are");
    refused("--element-size 0", "must be positive");
    refused("--degree 9", "not in range 1 to 8");
    refused("--stage hexes --points 2000", "not in range 2 to 1000");
    io::write_text(folder.path() / "file", "");
    refused("--out file", "is not a folder");
}
