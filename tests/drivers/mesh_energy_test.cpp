// `couture solve` on volumes of `couture mesh`: the energy converges.
#include <fmt/format.h>

#include <array>
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

// A held side meets free ones at right angles: there, and at re-entrant edges, stresses are
// singular, and the error of the energy falls by 2.1 to 2.7 per level where a smooth solution would
// give 16 at degree 2.
constexpr double least_ratio = 1.5;

// Elements of the volumes, per cuboid and direction, and of the spaces on them.
constexpr std::array<int, 3> levels{2, 4, 8};

double run_json(const std::string& arguments, const fs::path& folder,
                const nlohmann::json::json_pointer& number) {
    const ProgramResult result = run_couture(arguments + " --json", folder);
    INFO(arguments);
    INFO(result.errors);
    REQUIRE(result.exit_code == 0);
    return nlohmann::json::parse(result.output).at(number).get<double>();
}

// The ratio of the differences between energies at three levels.
double energy_ratio(const fs::path& volume, const std::string& held, const fs::path& folder) {
    const fs::path deck = folder / "energy.toml";
    io::write_text(deck, fmt::format("[geometry]\nfile = \"{}\"\n"
                                     "[material.steel]\n"
                                     "youngs_modulus = 210e3\npoissons_ratio = 0.3\n"
                                     "[[fixed]]\non = \"{}\"\n"
                                     "[[body_force]]\nvalue = [1e-3, 2e-3, 3e-3]\n"
                                     "[output]\nvtu = false\n",
                                     volume.string(), held));
    std::array<double, levels.size()> energies{};
    for (std::size_t k = 0; k < levels.size(); ++k) {
        energies[k] =
            run_json(fmt::format("solve energy.toml --set discretization.elements={}", levels[k]),
                     folder, "/cases/0/energy"_json_pointer);
    }
    CAPTURE(energies);
    // Each space contains the one before it, and nothing moves at the supports.
    CHECK(energies[1] > energies[0]);
    CHECK(energies[2] > energies[1]);
    return (energies[1] - energies[0]) / (energies[2] - energies[1]);
}

// Meshes with two elements per cuboid and direction, then solves.
//
// @param input  arguments of couture mesh beside --out
void check_energies(const std::string& input, const std::string& volume, const std::string& held,
                    const fs::path& folder) {
    const ProgramResult mesh = run_couture("mesh " + input + " --out mesh", folder);
    INFO(mesh.errors);
    REQUIRE(mesh.exit_code == 0);
    CHECK(energy_ratio("mesh/" + volume + "_volume.xml", held, folder) >= least_ratio);
}

}  // namespace

TEST_CASE("mesh, solve: differences of energies shrink with each refinement", "[drivers]") {
    const std::string to_volume = " --stage volume";
    const std::string with_caps = " --open caps --stage volume";
    // The volume's name, what is meshed, the side that is held.
    const auto [name, input, held] = GENERATE_COPY(table<std::string, std::string, std::string>({
        {"pant", "pant" + with_caps, "cap_1"},
        {"half_seal", "half_seal" + with_caps, "cap"},
        {"seal", "seal" + with_caps, "cap_x_low"},
        {"double_t", "double_t" + with_caps, "cap_1"},
        {"cylinder", "cylinder" + with_caps, "z_low"},
        {"cube", "cube" + to_volume, "x_low"},
        {"plate", "plate" + to_volume, "x_low"},
    }));
    CAPTURE(name);
    const TemporaryFolder folder;
    check_energies(input + " --element-size 1000", name, held, folder.path());
}

TEST_CASE("mesh, solve: differences of energies shrink on a vessel", "[drivers]") {
    const auto data = test::data_folder();
    if (!data) return;
    const TemporaryFolder folder;
    const std::string deck = "mesh_artery.toml";
    fs::copy_file(fs::path(COUTURE_SOURCE_DIR) / "tests/drivers/decks" / deck,
                  folder.path() / deck);
    fs::create_symlink(fs::absolute(*data / "surfaces/vampy_artery.stl"),
                       folder.path() / "vampy_artery.stl");
    check_energies(deck + " --set meshing.element_size=1000", "mesh_artery", "cap_1",
                   folder.path());
}
