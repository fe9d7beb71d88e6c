// From triangles to certified volumes.
#include <catch2/catch.hpp>
#include <filesystem>
#include <regex>

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
    const ProgramResult result = run_couture("mesh '" + deck.string() + "'", folder);
    INFO(result.errors);
    REQUIRE(result.exit_code == 0);
    INFO(result.output);
    const std::regex quality("det J valid, scaled Jacobian from ([-0-9.]+), mean ([-0-9.]+);");
    std::smatch found;
    REQUIRE(std::regex_search(result.output, found, quality));
    CHECK(std::stod(found[1]) >= least_scaled_jacobian);
    CHECK(std::stod(found[2]) >= least_mean);
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
