// From triangles to certified volumes.
#include <catch2/catch.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "io/atomic_file.h"
#include "tests/data_folder.h"
#include "tests/drivers/run_program.h"

using namespace couture;
using namespace couture::tests;

namespace fs = std::filesystem;

namespace {

// Quality that meshes of parts must have at least.
constexpr double least_scaled_jacobian = 0.2;
constexpr double least_mean = 0.8;

void check_volume(const fs::path& deck, const fs::path& folder) {
    const ProgramResult result = run_couture("mesh --json '" + deck.string() + "'", folder);
    INFO(result.errors);
    REQUIRE(result.exit_code == 0);
    const auto volume = nlohmann::json::parse(result.output).at("volume");
    CAPTURE(volume.dump());
    CHECK(volume.at("certificate") == "valid");
    CHECK(volume.at("min_scaled_jacobian") >= least_scaled_jacobian);
    CHECK(volume.at("mean_scaled_jacobian") >= least_mean);
}

}  // namespace

TEST_CASE("mesh: parts of genus 1 to 5 become valid volumes", "[drivers]") {
    const std::string name = GENERATE("torus", "plate", "plate_with_two_holes", "sierpinski");
    CAPTURE(name);
    const TemporaryFolder folder;
    check_volume(fs::path(COUTURE_SOURCE_DIR) / "drivers/decks" / ("mesh_" + name + ".toml"),
                 folder.path());
}

TEST_CASE("mesh: vessels and chambers of the heart become valid volumes", "[drivers]") {
    const auto data = test::data_folder();
    if (!data) return;
    const auto [name, surface] =
        GENERATE(table<std::string, std::string>({{"artery", "vampy_artery.stl"},
                                                  {"vein", "vampy_vein.stl"},
                                                  {"ventricle", "vampy_ventricle.stl"},
                                                  {"atrium", "vampy_moving_atrium_00.off"}}));
    CAPTURE(name);
    const TemporaryFolder folder;
    const std::string deck = "mesh_" + name + ".toml";
    fs::copy_file(fs::path(COUTURE_SOURCE_DIR) / "tests/drivers/decks" / deck,
                  folder.path() / deck);
    fs::create_symlink(fs::absolute(*data / "surfaces" / surface), folder.path() / surface);
    check_volume(folder.path() / deck, folder.path());
}

TEST_CASE("mesh: pictures of all stages and of nodes that move", "[drivers]") {
    const TemporaryFolder folder;
    io::write_text(folder.path() / "p.toml",
                   "[geometry]\npart = \"pant\"\n[meshing]\nopen = \"caps\"\nedge_length = 8\n"
                   "element_size = 20\nstage = \"volume\"\nalignment = 1\nrelocations = 3\n");
    const ProgramResult result = run_couture("mesh p.toml --png --json --out o", folder.path());
    INFO(result.errors);
    REQUIRE(result.exit_code == 0);
    const auto object = nlohmann::json::parse(result.output);
    CHECK(object["map"]["flipped"] == 0);
    CHECK(object["map"]["angle_to_field"] > 0.0);
    CHECK(object["field"]["singularities"].size() > 0);
    const auto& energies = object["quads"]["energy"];
    REQUIRE(energies.size() >= 2);
    CHECK(energies.size() <= 4);
    CHECK(energies.back() < energies.front());
    for (const char* picture : {"map", "field", "quads", "volume", "stages", "relocation"}) {
        const fs::path file = folder.path() / "o" / ("p_" + std::string(picture) + ".png");
        CAPTURE(file.string());
        REQUIRE(fs::exists(file));
        CHECK(fs::file_size(file) > 10'000);
    }
}
