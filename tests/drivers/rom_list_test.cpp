// Reduced models of members that are files.
#include <fmt/format.h>
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "io/atomic_file.h"
#include "tests/drivers/run_program.h"

using namespace couture;
using namespace couture::tests;
using Catch::Matchers::Contains;
using Json = nlohmann::json;

namespace {

namespace fs = std::filesystem;

std::string deck_of(const std::string& geometry, const std::string& rom) {
    return "[geometry]\n" + geometry +
           "\n[discretization]\nelements = 3\n"
           "[material.steel]\nyoungs_modulus = \"210 GPa\"\npoissons_ratio = 0.3\n"
           "[[symmetry]]\non = [\"cut_x\", \"cut_y\", \"z_low\"]\n"
           "[[traction]]\non = \"x_high\"\nvalue = [10, 0, 0]\n[rom]\n" +
           rom + "[[rom.parameter]]\nrange = [0.6, 1.4]\n";
}

const std::string listed =
    deck_of("file = \"plate_2.xml\"", "design = \"list\"\nmembers = \"members.csv\"\n") +
    "name = \"hole_radius\"\n";

// Plates with holes as spline files, and their table.
void write_members(const fs::path& folder, const std::string& table, int n, double first,
                   double step) {
    io::write_text(folder / "plate.toml",
                   deck_of("part = \"plate_with_hole_3d\"", "design = \"full\"\nsamples = 5\n") +
                       "key = \"geometry.parameters.hole_radius\"\n");
    std::string lines = "hole_radius, volume\n";
    for (int i = 0; i < n; ++i) {
        const double radius = first + i * step;
        io::write_text(folder / "one.toml",
                       deck_of(fmt::format("part = \"plate_with_hole_3d\"\n[geometry.parameters]\n"
                                           "hole_radius = {}",
                                           radius),
                               "design = \"full\"\nsamples = 5\n") +
                           "key = \"geometry.parameters.hole_radius\"\n");
        const std::string file = fmt::format("{}_{}.xml", fs::path(table).stem().string(), i);
        REQUIRE(run_couture("convert one.toml " + file, folder).exit_code == 0);
        lines += fmt::format("{}, {}\n", radius, file);
    }
    io::write_text(folder / table, lines);
}

Json run_json(const std::string& arguments, const fs::path& folder) {
    const ProgramResult result = run_couture(arguments + " --json", folder);
    INFO(arguments);
    INFO(result.errors);
    REQUIRE(result.exit_code == 0);
    return Json::parse(result.output);
}

}  // namespace

TEST_CASE("rom: members in spline files give the model of the part that they are of", "[drivers]") {
    const TemporaryFolder folder;
    const fs::path& at = folder.path();
    write_members(at, "plate.csv", 5, 0.6, 0.2);
    write_members(at, "others.csv", 3, 0.7, 0.25);
    fs::copy_file(at / "plate.csv", at / "members.csv");
    io::write_text(at / "listed.toml", listed);
    run_json("rom train plate.toml --out o", at);
    run_json("rom train listed.toml --out l", at);
    const Json part = run_json("rom eval o/plate.rom --set hole_radius=1.13", at);
    const Json list = run_json("rom eval l/listed.rom --set hole_radius=1.13", at);
    for (const char* key : {"displacement_max", "von_mises_max", "volume"}) {
        CAPTURE(key);
        CHECK(list.at(key).get<double>() == Approx(part.at(key).get<double>()).epsilon(1e-8));
    }

    const auto refused = [&](const std::string& arguments, const std::string& text) {
        const ProgramResult result = run_couture(arguments, at);
        CHECK(result.exit_code == 2);
        CHECK_THAT(result.errors, Contains(text));
    };
    refused("rom validate listed.toml --out l", "write 'validation' = a table");
    refused("rom enrich listed.toml --out l --tolerance 0.01", "add lines to members.csv");
    refused("rom eval l/listed.rom --set hole_radius=1.13 --solve", "no member of members.csv");
    // The middle of the table is there in full.
    CHECK(run_couture("rom eval l/listed.rom --set hole_radius=1.0 --solve", at).exit_code == 0);

    io::write_text(at / "validated.toml", deck_of("file = \"plate_2.xml\"",
                                                  "design = \"list\"\nmembers = \"members.csv\"\n"
                                                  "validation = \"others.csv\"\n") +
                                              "name = \"hole_radius\"\n");
    run_json("rom train validated.toml --out v", at);
    const Json validation = run_json("rom validate validated.toml --out v", at);
    CHECK(validation.at("points") == 3);
    CHECK(validation.at("errors").at("displacement").at("worst") < 0.02);
}

TEST_CASE("rom: tables of members that are wrong are refused with their line", "[drivers]") {
    const TemporaryFolder folder;
    const fs::path& at = folder.path();
    write_members(at, "plate.csv", 3, 0.6, 0.4);
    const auto refused = [&](const std::string& table, const std::string& text) {
        io::write_text(at / "members.csv", table);
        io::write_text(at / "listed.toml", listed);
        const ProgramResult result = run_couture("rom train listed.toml --out o", at);
        CAPTURE(table, result.errors);
        CHECK(result.exit_code == 2);
        CHECK_THAT(result.errors, Contains(text));
    };
    refused("hole_radius,volume\n0.6,none.xml\n", "members.csv:2: there is no file");
    refused("hole_radius,volume\n0.5,plate_0.xml\n", "out of its range [0.6, 1.4]");
    refused("hole_radus,volume\n0.6,plate_0.xml\n", "did you mean 'hole_radius'");
    refused("volume\nplate_0.xml\n", "no column 'hole_radius'");
    io::write_text(at / "no_list.toml",
                   deck_of("file = \"plate_0.xml\"", "design = \"list\"\n") + "name = \"r\"\n");
    const ProgramResult result = run_couture("rom train no_list.toml --out o", at);
    CHECK(result.exit_code == 2);
    CHECK_THAT(result.errors, Contains("design = \"list\" needs 'members'"));
}
