// `couture solve` on volumes of `couture mesh`: the energy converges.
#include <fmt/format.h>

#include <array>
#include <catch2/catch.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "io/atomic_file.h"
#include "tests/data_folder.h"
#include "tests/drivers/run_program.h"

using namespace couture;
using namespace couture::tests;

namespace fs = std::filesystem;

namespace {

// A held side meets free ones at right angles: there, and at re-entrant edges, stresses are
// singular, and the error of the energy falls by 2.1 to 2.7 per level where a smooth solution would
// give 16 at degree 2.
constexpr double least_ratio = 1.5;

// Spaces have the volume's elements, halved as often.
constexpr int n_levels = 3;

double run_json(const std::string& arguments, const fs::path& folder,
                const nlohmann::json::json_pointer& number) {
    const ProgramResult result = run_couture(arguments + " --json", folder);
    INFO(arguments);
    INFO(result.errors);
    REQUIRE(result.exit_code == 0);
    return nlohmann::json::parse(result.output).at(number).get<double>();
}

// The ratio of the differences between energies at three levels.
//
// @param n_elements  of the volume, per cuboid and direction
double energy_ratio(const fs::path& volume, const std::string& held, int n_elements,
                    const fs::path& folder) {
    const fs::path deck = folder / "energy.toml";
    io::write_text(deck, fmt::format("[geometry]\nfile = \"{}\"\n"
                                     "[material.steel]\n"
                                     "youngs_modulus = 210e3\npoissons_ratio = 0.3\n"
                                     "[[fixed]]\non = \"{}\"\n"
                                     "[[body_force]]\nvalue = [1e-3, 2e-3, 3e-3]\n"
                                     "[output]\nvtu = false\n",
                                     volume.string(), held));
    std::array<double, n_levels> energies{};
    for (int k = 0; k < n_levels; ++k) {
        energies[k] = run_json(
            fmt::format("solve energy.toml --set discretization.elements={}", n_elements << k),
            folder, "/cases/0/energy"_json_pointer);
    }
    CAPTURE(energies);
    // Each space contains the one before it, and nothing moves at the supports.
    CHECK(energies[1] > energies[0]);
    CHECK(energies[2] > energies[1]);
    return (energies[1] - energies[0]) / (energies[2] - energies[1]);
}

// Meshes with as many elements per cuboid and direction, whatever their size, then solves.
void check_energies(const std::string& deck, const std::string& held, int n_elements,
                    const fs::path& folder) {
    const ProgramResult mesh = run_couture(
        fmt::format("mesh {}.toml --set meshing.element_size=1000 --set meshing.min_elements={} "
                    "--out mesh",
                    deck, n_elements),
        folder);
    INFO(mesh.errors);
    REQUIRE(mesh.exit_code == 0);
    CHECK(energy_ratio("mesh/" + deck + "_volume.xml", held, n_elements, folder) >= least_ratio);
}

}  // namespace

TEST_CASE("mesh, solve: differences of energies shrink with each refinement", "[drivers]") {
    // The part, whether its caps are taken off, the side that is held.
    const auto [part, has_caps, held] = GENERATE(table<std::string, bool, std::string>({
        {"pant", true, "cap_1"},
        {"half_seal", true, "cap"},
        {"seal", true, "cap_x_low"},
        {"double_t", true, "cap_1"},
        {"cylinder", true, "z_low"},
        {"cube", false, "x_low"},
        {"plate", false, "x_low"},
    }));
    CAPTURE(part);
    const TemporaryFolder folder;
    io::write_text(folder.path() / (part + ".toml"),
                   fmt::format("[geometry]\npart = \"{}\"\n[meshing]\nstage = \"volume\"\n{}", part,
                               has_caps ? "open = \"caps\"\n" : ""));
    check_energies(part, held, 2, folder.path());
}

TEST_CASE("mesh, solve: differences of energies shrink on a casting", "[drivers]") {
    const TemporaryFolder folder;
    const std::string deck = "mesh_casting_volume";
    fs::copy_file(fs::path(COUTURE_SOURCE_DIR) / "drivers/decks" / (deck + ".toml"),
                  folder.path() / (deck + ".toml"));
    check_energies(deck, "bottom", 1, folder.path());
}

TEST_CASE("mesh, solve: differences of energies shrink on vessels", "[drivers]") {
    const auto data = test::data_folder();
    if (!data) return;
    const auto [deck, surface, held] = GENERATE(table<std::string, std::string, std::string>(
        {{"mesh_artery", "vampy_artery.stl", "cap_1"}, {"mesh_vein", "vampy_vein.stl", "cap_1"}}));
    CAPTURE(deck);
    const TemporaryFolder folder;
    fs::copy_file(fs::path(COUTURE_SOURCE_DIR) / "tests/drivers/decks" / (deck + ".toml"),
                  folder.path() / (deck + ".toml"));
    fs::create_symlink(fs::absolute(*data / "surfaces" / surface), folder.path() / surface);
    check_energies(deck, held, 2, folder.path());
}
