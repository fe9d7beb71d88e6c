// A reduced model at finite strain.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "tests/drivers/run_program.h"

using namespace couture;
using namespace couture::tests;
using Json = nlohmann::json;

namespace {

const std::string deck = "'" COUTURE_SOURCE_DIR "/drivers/decks/rubber_family.toml'";
const std::string coarse = " --set rom.samples=8 --set discretization.elements=2 --out o";

Json run_json(const std::string& arguments, const std::filesystem::path& folder) {
    const ProgramResult result = run_couture(arguments + " --json", folder);
    INFO(arguments);
    INFO(result.errors);
    REQUIRE(result.exit_code == 0);
    return Json::parse(result.output);
}

}  // namespace

TEST_CASE("rom: stretched rubber is predicted, and a step of Newton in the modes improves that",
          "[drivers]") {
    const TemporaryFolder folder;
    run_json("rom train " + deck + coarse, folder.path());
    const Json validation =
        run_json("rom validate " + deck + " -n 10 --galerkin" + coarse, folder.path());
    const auto mean = [&](const char* of) {
        return validation.at(of).at("displacement").at("mean").get<double>();
    };
    CAPTURE(validation.dump());
    CHECK(mean("errors") < 0.02);
    CHECK(mean("galerkin_errors") < 0.3 * mean("errors"));
    CHECK(validation.at("errors").at("von_mises_max").at("mean") < 0.03);

    const Json answer = run_json(
        "rom eval o/rubber_family.rom --set stretch=1.8 --galerkin --solve", folder.path());
    const Json& galerkin = answer.at("galerkin");
    CHECK(galerkin.at("relative_residual") <
          0.3 * galerkin.at("relative_residual_of_kriging").get<double>());
    CHECK(answer.at("galerkin_errors").at("displacement") < 0.01);
}
