#include <catch2/catch.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "iga/topology/side_patch.h"
#include "io/atomic_file.h"
#include "io/spline_file.h"
#include "meshing/parts/parts.h"
#include "tests/data_folder.h"
#include "tests/drivers/run_program.h"

using namespace couture;
using namespace couture::tests;
using Catch::Matchers::Contains;

namespace fs = std::filesystem;

TEST_CASE("mesh: six surfaces of a duck become a volume", "[drivers]") {
    // Two of its sides meet nearly flat: there a volume is positive, if at all, by a little.
    const auto data = test::data_folder();
    if (!data) return;
    const TemporaryFolder folder;
    const std::string file = fs::absolute(*data / "volumes/gismo_duck_BRep.xml").string();
    const auto result =
        run_couture("mesh '" + file + "' --stage volume --out o --json", folder.path());
    INFO(result.errors);
    REQUIRE(result.exit_code == 0);
    const auto volume = nlohmann::json::parse(result.output)["volume"];
    CHECK(volume["certificate"] == "valid");
    CHECK(volume["patches"] == 1);
}

TEST_CASE("mesh: surfaces of a pipe become volumes and hexahedra", "[drivers]") {
    const TemporaryFolder folder;
    const auto pipe = std::get<iga::MultiPatch<3>>(meshing::make_part("pipe_tee"));
    iga::MultiPatch<2> surfaces;
    for (int p = pipe.n_patches(); p-- > 0;) {
        for (int side = 0; side < 6; ++side) {
            surfaces.patches.push_back(
                iga::entity_patch<3, 2>(pipe.patches[p], iga::make_side<3>(p, side).position));
        }
    }
    io::write_splines(folder.path() / "pipe.xml", surfaces);
    const auto result = run_couture("mesh pipe.xml --stage hexes --json", folder.path());
    REQUIRE(result.exit_code == 0);
    const auto object = nlohmann::json::parse(result.output);
    CHECK(object["volume"]["patches"] == 12);
    CHECK(object["volume"]["certificate"] == "valid");
    CHECK(object["volume"]["volume"].get<double>() == Approx(iga::volume(pipe)).epsilon(1e-9));
    CHECK(object["surfaces"]["unused"].empty());
    CHECK(object["surfaces"]["duplicates"].size() == pipe.interfaces.size());
    CHECK(object["hexes"]["certificate"] == "valid");
    CHECK(object["files"].size() == 4);
    for (const auto& file : object["files"]) {
        CHECK(std::filesystem::exists(folder.path() / file.get<std::string>()));
    }
    CHECK_THAT(io::read_text(folder.path() / "out/pipe/pipe_hexes.inp"),
               Contains("*ELEMENT, TYPE=C3D8"));

    const auto finer = run_couture(
        "mesh out/pipe/pipe_volume.xml --stage hexes --points 4 --out finer --json", folder.path());
    REQUIRE(finer.exit_code == 0);
    CHECK(nlohmann::json::parse(finer.output)["hexes"]["elements"] == 12 * 27);

    for (const auto& [arguments, message] : std::vector<std::pair<std::string, std::string>>{
             {"mesh pipe.xml", "--stage must be volume or hexes"},
             {"mesh pipe.xml --stage pants", "not pants"},
             {"mesh pipe.xml --stage volume --points 4", "--points 4 is for --stage hexes"},
             {"mesh pipe.xml --stage hexes --points 1", "not in range 2 to 1000"},
             {"mesh pipe.xml --stage volume --png", "only --stage, --points and --out"},
             {"mesh out/pipe/pipe_volume.xml --stage volume", "holds volumes"},
             {"mesh plate --points 3", "3 points are for stage hexes"},
             {"mesh cube --stage hexes --points 1", "not in range 2 to 1000"}}) {
        const auto refused = run_couture(arguments, folder.path());
        CAPTURE(arguments);
        CHECK(refused.exit_code == 2);
        CHECK_THAT(refused.errors, Contains(message));
    }
}
