// A family of surfaces that were triangulated each on its own.
#include <catch2/catch.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "io/atomic_file.h"
#include "io/off_surface.h"
#include "io/surface_reader.h"
#include "meshing/surface/repair.h"
#include "tests/data_folder.h"
#include "tests/drivers/remeshed_surface.h"
#include "tests/drivers/run_program.h"

using namespace couture;
using namespace couture::tests;

namespace fs = std::filesystem;

namespace {

double mean_edge_length(const meshing::TriangleSoup& soup) {
    double sum = 0.0;
    for (const auto& triangle : soup.triangles) {
        for (int k = 0; k < 3; ++k) {
            sum += (soup.points[triangle[(k + 1) % 3]] - soup.points[triangle[k]]).norm();
        }
    }
    return sum / (3.0 * static_cast<double>(soup.triangles.size()));
}

}  // namespace

TEST_CASE("mesh family: an atrium in four frames of its motion, triangulated each on its own",
          "[drivers]") {
    const auto data = test::data_folder();
    if (!data) return;
    const TemporaryFolder folder;
    std::vector<std::size_t> n_triangles;
    for (unsigned k = 0; k < 4; ++k) {
        const std::string name = std::string(k < 2 ? "0" : "") + std::to_string(5 * k) + ".off";
        // Their triangles run against each other.
        const meshing::TriangleSoup frame =
            meshing::repair_surface(
                io::read_surface(*data / "surfaces" / ("vampy_moving_atrium_" + name)))
                .soup;
        const double part = 1.0 - 0.05 * k;
        const meshing::TriangleSoup own = remeshed(frame, part * mean_edge_length(frame), k);
        n_triangles.push_back(own.triangles.size());
        io::write_off(folder.path() / ("atrium_" + name), own, "");
    }
    for (std::size_t k = 1; k < 4; ++k) CHECK(n_triangles[k] != n_triangles[0]);
    for (const char* file : {"mesh_atrium_frames.toml", "atrium_frames.csv"}) {
        fs::copy_file(fs::path(COUTURE_SOURCE_DIR) / "tests/drivers/decks" / file,
                      folder.path() / file);
    }
    const ProgramResult result =
        run_couture("mesh mesh_atrium_frames.toml --png --json --out o", folder.path());
    INFO(result.errors);
    REQUIRE(result.exit_code == 0);
    const auto family = nlohmann::json::parse(result.output);
    REQUIRE(family.at("members").size() == 4);
    for (const auto& member : family.at("members")) {
        CAPTURE(member.dump());
        CHECK(member.at("status") == "done");
        CHECK(member.at("certificate") == "valid");
        CHECK(member.at("signature") == family.at("signature"));
        CHECK(member.at("min_scaled_jacobian") >= 0.2);
        CHECK(member.at("mean_scaled_jacobian") >= 0.8);
        CHECK(member.at("hausdorff") <= 3e-3);
    }
    CHECK(family.at("failed_midpoints") == 0);
    CHECK(fs::file_size(folder.path() / "o/mesh_atrium_frames_family.png") > 10'000);
}
