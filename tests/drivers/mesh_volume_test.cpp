// From triangles to certified volumes.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "iga/spline/refine.h"
#include "iga/topology/jacobian_certificate.h"
#include "io/atomic_file.h"
#include "io/spline_file.h"
#include "tests/data_folder.h"
#include "tests/drivers/run_program.h"

using namespace couture;
using namespace couture::tests;

namespace fs = std::filesystem;

namespace {

// Quality that meshes of parts must have at least.
constexpr double least_scaled_jacobian = 0.2;
constexpr double least_mean = 0.8;

// Largest distance of splines and surface over its diagonal.
constexpr double most_distance_of_parts = 1e-3;
constexpr double most_distance_of_organs = 3e-3;

void check_volume(const fs::path& deck, const fs::path& folder, double most_distance) {
    const ProgramResult result = run_couture("mesh --json '" + deck.string() + "'", folder);
    INFO(result.errors);
    REQUIRE(result.exit_code == 0);
    const auto volume = nlohmann::json::parse(result.output).at("volume");
    CAPTURE(volume.dump());
    CHECK(volume.at("certificate") == "valid");
    CHECK(volume.at("min_scaled_jacobian") >= least_scaled_jacobian);
    CHECK(volume.at("mean_scaled_jacobian") >= least_mean);
    CHECK(volume.at("hausdorff") <= most_distance);
}

}  // namespace

TEST_CASE("mesh: parts of genus 1 to 5 become valid volumes", "[drivers]") {
    const std::string name =
        GENERATE("torus", "double_torus", "plate", "plate_with_two_holes", "sierpinski");
    CAPTURE(name);
    const TemporaryFolder folder;
    check_volume(fs::path(COUTURE_SOURCE_DIR) / "drivers/decks" / ("mesh_" + name + ".toml"),
                 folder.path(), most_distance_of_parts);
}

TEST_CASE("mesh: a file's boundary splines, and hexahedra of its volume with sets", "[drivers]") {
    const TemporaryFolder folder;
    REQUIRE(run_couture("convert cube cube.stl --set length=20", folder.path()).exit_code == 0);
    const auto run = [&](const std::string& arguments) {
        const ProgramResult result =
            run_couture("mesh cube.stl --json " + arguments, folder.path());
        INFO(result.errors);
        REQUIRE(result.exit_code == 0);
        return nlohmann::json::parse(result.output);
    };
    const auto surfaces = run("--stage surfaces").at("surfaces");
    CHECK(surfaces.at("patches") == 6);
    CHECK(surfaces.at("area").get<double>() == Approx(2400.0));
    const auto file = io::read_spline_surfaces(folder.path() / "out/cube/cube_surfaces.xml");
    REQUIRE(file);
    CHECK(file->size() == 6);
    const Vector3 middle = Vector3::Constant(10.0);
    for (const auto& surface : *file) {
        const MatrixX jacobian = surface.jacobian(Vector2(0.5, 0.5));
        const Vector3 normal = Vector3(jacobian.col(0)).cross(Vector3(jacobian.col(1)));
        CHECK(normal.dot(Vector3(surface.point(Vector2(0.5, 0.5))) - middle) > 0.0);
    }

    const auto hexes = run("--stage hexes --points 4 --element-size 10");
    CHECK(hexes.at("hexes").at("elements") == 27);
    CHECK(hexes.at("hexes").at("certificate") == "valid");
    CHECK(hexes.at("hexes").at("min_scaled_jacobian").get<double>() == Approx(1.0));
    const std::string inp = io::read_text(folder.path() / "out/cube/cube_hexes.inp");
    CHECK_THAT(inp, Catch::Contains("*ELEMENT, TYPE=C3D8") && Catch::Contains("NSET=FACE_1"));
    CHECK(fs::exists(folder.path() / "out/cube/cube_hexes.vtu"));

    // A deck loads the smooth faces of the file.
    io::write_text(folder.path() / "load.toml",
                   "[geometry]\nfile = \"out/cube/cube_volume.xml\"\n"
                   "[material.steel]\nyoungs_modulus = 210e3\npoissons_ratio = 0.3\n"
                   "[[symmetry]]\non = [\"face_1\", \"face_3\", \"face_5\"]\n"
                   "[[pressure]]\non = \"face_6\"\nvalue = 10.0\n"
                   "[[output.probe]]\nat = [5, 5, 5]\nquantity = \"stress_zz\"\n"
                   "expect = -10.0\ntolerance = 1e-6\n");
    const ProgramResult solved = run_couture("solve load.toml", folder.path());
    INFO(solved.errors);
    CHECK(solved.exit_code == 0);
}

TEST_CASE("mesh: a layout written by hand is drawn and filled, bad ones are refused", "[drivers]") {
    const TemporaryFolder folder;
    const auto write = [&](const std::string& middle) {
        io::write_text(folder.path() / "two.toml",
                       "[nodes]\n"
                       "a = \"x_low-y_low-z_low\"\nb = \"x_low-y_high-z_low\"\n"
                       "c = \"x_low-y_low-z_high\"\nd = \"x_low-y_high-z_high\"\n"
                       "e = [40, 0, 0.5]\nf = [40, 100, 0]\ng = " +
                           middle +
                           "\nh = [40, 100, 100]\n"
                           "i = [100, 0, 0]\nj = [100, 100, 0]\nk = [100, 0, 100]\n"
                           "l = [100, 100, 100]\n"
                           "[[cuboid]]\nnodes = ['a', 'e', 'b', 'f', 'c', 'g', 'd', 'h']\n"
                           "[[cuboid]]\nnodes = ['e', 'i', 'f', 'j', 'g', 'k', 'h', 'l']\n");
        io::write_text(folder.path() / "job.toml",
                       "[geometry]\npart = \"cube\"\n[meshing]\nstage = \"volume\"\n"
                       "layout = \"two.toml\"\nelement_size = 20\n");
    };
    write("[40, 0, 100]");
    const ProgramResult result = run_couture("mesh --json job.toml", folder.path());
    INFO(result.errors);
    REQUIRE(result.exit_code == 0);
    const auto volume = nlohmann::json::parse(result.output).at("volume");
    CHECK(volume.at("patches") == 2);
    CHECK(volume.at("certificate") == "valid");
    CHECK(volume.at("min_scaled_jacobian") > 0.95);
    const auto refused = [&](const std::string& middle, const std::string& message) {
        write(middle);
        const ProgramResult bad = run_couture("mesh job.toml --stage layout", folder.path());
        CHECK(bad.exit_code == 2);
        CHECK_THAT(bad.errors, Catch::Contains(message));
    };
    refused("[40, -20, 100]", "node 'g' at (40, -20, 100) lies 20 from the surface");
    refused("[0.5, 0, 100]", "nodes 'c' and 'g' both come to (0, 0, 100)");
    refused("\"x_mid\"", "node 'g' lies at the corner 'x_mid', which the part does not have");
    refused("[40, 50, 50]", "from the surface, which is more than 'tolerance'");
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
    check_volume(folder.path() / deck, folder.path(), most_distance_of_organs);
}

TEST_CASE("mesh: degree 3 is certified, as are its halved elements", "[drivers]") {
    const auto data = test::data_folder();
    const std::string name = GENERATE("double_torus", "plate", "vein");
    CAPTURE(name);
    const bool is_vein = name == "vein";
    if (is_vein && !data) return;
    const TemporaryFolder folder;
    if (is_vein) {
        fs::create_symlink(fs::absolute(*data / "surfaces/vampy_vein.stl"),
                           folder.path() / "vampy_vein.stl");
    }
    const std::string deck = "mesh_" + name + ".toml";
    fs::copy_file(
        fs::path(COUTURE_SOURCE_DIR) / (is_vein ? "tests/drivers/decks" : "drivers/decks") / deck,
        folder.path() / deck);
    const ProgramResult result =
        run_couture("mesh --json --set meshing.degree=3 --out o " + deck, folder.path());
    INFO(result.errors);
    REQUIRE(result.exit_code == 0);
    const auto volume = nlohmann::json::parse(result.output).at("volume");
    CHECK(volume.at("certificate") == "valid");
    CHECK(volume.at("min_scaled_jacobian") >= least_scaled_jacobian);
    CHECK(volume.at("mean_scaled_jacobian") >= least_mean);
    const auto made = std::get<iga::MultiPatch<3>>(
        io::read_splines(folder.path() / "o" / ("mesh_" + name + "_volume.xml")).multipatch);
    for (const iga::Volume& patch : made.patches) {
        iga::TensorSpace<3> finer = patch.space();
        for (iga::KnotVector& knots : finer.knots) {
            knots = iga::refine(knots, 3, 2 * knots.n_elements()).knots;
        }
        CHECK(iga::certify<3>(iga::refine_to<3>(patch, finer)).validity == iga::Validity::valid);
    }
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
