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
    CHECK(object["files"].size() == 4);
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
    const auto weights = run_couture(
        "mesh plate_with_two_holes --edge-length 8 --cycle length=1 symmetry=4 --merge length=1",
        folder.path());
    CHECK(weights.exit_code == 0);
    CHECK_THAT(weights.output, Contains("2 pants"));
}

TEST_CASE("mesh: mistakes are explained", "[drivers]") {
    const TemporaryFolder folder;
    const auto refused = [&](const std::string& arguments, const std::string& text) {
        const auto result = run_couture("mesh " + arguments, folder.path());
        CHECK(result.exit_code == 2);
        CHECK_THAT(result.errors, Contains(text));
    };
    refused("plate --stage pant", "did you mean 'pants'?");
    refused("plate --set P1", "write NAME=NUMBER");
    refused("plate --set P9=3", "unknown parameter 'P9'");
    refused("plate --cycle weight=3", "has no term 'weight'");
    refused("no_such.stl", "no_such.stl");
    refused("plate --feature-angle 270", "angle");
    io::write_text(folder.path() / "text.stl", "a letter to a friend\n");
    refused("text.stl", "text.stl");
    io::write_text(folder.path() / "fan.off",
                   "OFF\n5 3 0\n0 0 0\n1 0 0\n0 1 0\n0 -1 0\n0 0 1\n3 0 1 2\n3 0 3 1\n3 0 1 4\n");
    refused("fan.off", "with 3 triangles: 0, 1, 2");
    refused("fan.off --edge-length 3", "are for parts");
    io::write_text(folder.path() / "inside_out.off",
                   "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 1 2\n3 0 3 1\n3 1 3 2\n3 2 3 0\n");
    const auto turned = run_couture("mesh inside_out.off", folder.path());
    CHECK(turned.exit_code == 0);
    CHECK_THAT(turned.errors, Contains("inside out"));
}
