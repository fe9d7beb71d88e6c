// The lightest member and what results depend on, from a model's file to answers.
#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "drivers/rom_answer.h"
#include "io/atomic_file.h"
#include "tests/drivers/run_program.h"

using namespace couture;
using namespace couture::tests;
using Catch::Matchers::Contains;
using Json = nlohmann::json;

namespace {

namespace fs = std::filesystem;

// A wider hole makes the plate lighter and weaker, a thicker plate heavier and stronger.
const std::string deck = R"(title = "Plate with a hole"
[geometry]
part = "plate_with_hole_3d"
[discretization]
elements = 3
[material.steel]
youngs_modulus = "210 GPa"
poissons_ratio = 0.3
density = "7.85 g/cm^3"
[[symmetry]]
on = ["cut_x", "cut_y", "z_low"]
[[resultant]]
on = "x_high"
force = [40, 0, 0]
[rom]
design = "full"
samples = 4
[[rom.parameter]]
key = "geometry.parameters.hole_radius"
range = [0.6, 1.4]
unit = "mm"
[[rom.parameter]]
key = "geometry.parameters.thickness"
range = [0.5, 2]
unit = "mm"
[[rom.parameter]]
name = "load"
key = "resultant.0.force.0"
range = [20, 60]
unit = "N"
factored = true
)";

Json run_json(const std::string& arguments, const fs::path& folder, int exit_code = 0) {
    const auto result = run_couture(arguments + " --json", folder);
    CAPTURE(arguments, result.errors);
    REQUIRE(result.exit_code == exit_code);
    return Json::parse(result.output);
}

double value_of(const Json& parameters, const std::string& name) {
    for (const Json& one : parameters) {
        if (one["name"] == name) return one["value"];
    }
    FAIL("no parameter " + name);
    return 0.0;
}

/// Of a quarter of the plate.
double volume_of(double hole_radius, double thickness) {
    return thickness * (16.0 - 0.25 * std::numbers::pi * hole_radius * hole_radius);
}

}  // namespace

TEST_CASE("rom optimize: the lightest plate is that of a dense scan", "[drivers]") {
    const TemporaryFolder folder;
    io::write_text(folder.path() / "f.toml", deck);
    REQUIRE(run_couture("rom train f.toml --out o", folder.path()).exit_code == 0);
    const std::string limits = "--stress-limit '60 MPa' --displacement-limit 0.0006";
    const Json found =
        run_json("rom optimize o/f.rom --fix load=50 --starts 4 " + limits, folder.path());
    CHECK(found["status"] == "done");
    CHECK(found["minimized"] == "mass");
    CHECK(found["limits"]["von_mises"] == 60.0);
    CHECK(found["free"] == Json({"hole_radius", "thickness"}));
    CHECK(value_of(found["parameters"], "load") == 50.0);
    REQUIRE(found["starts"].size() == 4);
    CHECK(found["violation"] <= 1e-6);
    CHECK(found["violation"] > -2e-3);
    for (const Json& start : found["starts"]) {
        CHECK((start["violation"] > 1e-6 ||
               start["mass"].get<double>() >= found["mass"].get<double>() * (1.0 - 1e-12)));
    }

    // 33 x 33 members by the model, as rom eval computes them.
    const drivers::TrainedModel trained(folder.path() / "o/f.rom");
    const rom::FieldSampler sampler = drivers::answer_sampler(trained.model());
    const iga::Problem problem = trained.deck_at(trained.point_of({})).problem;
    constexpr int n = 32;
    double least = 1e300;
    for (int i = 0; i <= n; ++i) {
        for (int j = 0; j <= n; ++j) {
            const Vector3 point(0.6 + 0.8 * i / n, 0.5 + 1.5 * j / n, 50.0);
            if (volume_of(point[0], point[1]) > least) continue;
            const rom::Evaluation evaluation = trained.model().evaluate(point);
            const drivers::RomExtremes extremes = drivers::extremes_of(
                sampler.sample(evaluation.control_points, evaluation.displacement, problem));
            if (extremes.von_mises <= 60.0 && extremes.displacement <= 6e-4) {
                least = volume_of(point[0], point[1]);
            }
        }
    }
    REQUIRE(least < 1e300);
    const double volume = found["volume"];
    CAPTURE(volume, least, found["parameters"].dump());
    CHECK(found["mass"].get<double>() == Approx(7.85e-6 * volume).epsilon(1e-9));
    CHECK(volume <= least * (1.0 + 1e-3));
    // The scan's steps in thickness are 2 to 9 % of the volume.
    CHECK(volume >= least * 0.91);
    CHECK(volume == Approx(volume_of(value_of(found["parameters"], "hole_radius"),
                                     value_of(found["parameters"], "thickness")))
                        .epsilon(1e-3));

    // The full solution of the optimum.
    CHECK(found["full"]["errors"]["displacement"] < 0.01);
    CHECK(found["full"]["von_mises_max"].get<double>() ==
          Approx(found["von_mises_max"].get<double>()).epsilon(0.02));

    // The same again; without the solution where it is not wanted.
    const Json again = run_json(
        "rom optimize o/f.rom --fix load=50 --starts 4 --no-solve " + limits, folder.path());
    CHECK(again["starts"] == found["starts"]);
    CHECK(again.count("full") == 0);
    // A dimension that stays.
    const Json fixed = run_json(
        "rom optimize o/f.rom --fix load=50 --fix 'hole_radius=0.001 m' --no-solve " + limits,
        folder.path());
    CHECK(value_of(fixed["parameters"], "hole_radius") == 1.0);
    CHECK(fixed["mass"] >= found["mass"]);
    const auto text = run_couture("rom optimize o/f.rom --fix load=50 " + limits, folder.path());
    CHECK(text.exit_code == 0);
    CHECK_THAT(text.output, Contains("least mass with von Mises up to 60 MPa") &&
                                Contains("displacement up to 0.0006 mm") && Contains("in full"));
}

TEST_CASE("rom optimize: limits that can't be kept, and what is wrong", "[drivers]") {
    const TemporaryFolder folder;
    io::write_text(folder.path() / "f.toml", deck);
    REQUIRE(run_couture("rom train f.toml --out o", folder.path()).exit_code == 0);
    const Json none =
        run_json("rom optimize o/f.rom --stress-limit 5 --starts 3 --no-solve", folder.path(), 1);
    CHECK(none["status"] == "infeasible");
    // The nearest has the least stress: no more than a small hole in the thickest plate.
    const Json thick =
        run_json("rom eval o/f.rom --set hole_radius=0.6 --set thickness=2", folder.path());
    CHECK(none["von_mises_max"].get<double>() <= thick["von_mises_max"].get<double>() * 1.001);
    CHECK(value_of(none["parameters"], "thickness") > 1.8);
    CHECK(none["violation"].get<double>() ==
          Approx(none["von_mises_max"].get<double>() / 5.0 - 1.0).epsilon(1e-9));
    const auto said =
        run_couture("rom optimize o/f.rom --stress-limit 5 --no-solve", folder.path());
    CHECK(said.exit_code == 1);
    CHECK_THAT(said.output, Contains("no member keeps these limits: the nearest is"));

    const auto error_of = [&](const std::string& options) {
        const auto result = run_couture("rom optimize o/f.rom " + options, folder.path());
        CAPTURE(options);
        CHECK(result.exit_code == 2);
        return result.errors;
    };
    CHECK_THAT(error_of(""), Contains("--stress-limit, --displacement-limit or both"));
    CHECK_THAT(error_of("--stress-limit '3 mm'"), Contains("expected a pressure"));
    CHECK_THAT(error_of("--stress-limit much"), Contains("--stress-limit 'much'"));
    CHECK_THAT(error_of("--displacement-limit=-1"), Contains("is not positive"));
    CHECK_THAT(error_of("--stress-limit 60 --fix hole=1"),
               Contains("no parameter is called 'hole'"));
    CHECK_THAT(error_of("--stress-limit 60 --fix 'load=1 mm'"),
               Contains("--fix load=1 mm: is a length, not a force"));
    CHECK_THAT(error_of("--stress-limit 60 --fix hole_radius=1 --fix thickness=1"),
               Contains("no geometric parameter"));
    CHECK_THAT(error_of("--stress-limit 60 --fix hole_radius=9"), Contains("lies outside of"));
    fs::remove(folder.path() / "f.toml");
    CHECK_THAT(error_of("--stress-limit 60"), Contains("the full solution (without --no-solve)"));
}

TEST_CASE("rom sensitivity: indices of a plate", "[drivers]") {
    const TemporaryFolder folder;
    io::write_text(folder.path() / "f.toml", deck);
    REQUIRE(run_couture("rom train f.toml --out o", folder.path()).exit_code == 0);
    const Json found = run_json("rom sensitivity o/f.rom --samples 256", folder.path());
    CHECK(found["evaluations"] == 256 * 5);
    REQUIRE(found["quantities"].size() == 3);
    const Json& volume = found["quantities"][2];
    CHECK(volume["name"] == "volume");
    // The volume is thickness (16 - pi r^2 / 4): its indices are known, the load has none.
    constexpr double pi = std::numbers::pi;
    const double mean_t = 1.25;
    const double var_t = 1.5 * 1.5 / 12.0;
    const auto power_mean = [](int k) {
        return (std::pow(1.4, k + 1) - std::pow(0.6, k + 1)) / (0.8 * (k + 1));
    };
    const double mean_a = 16.0 - pi / 4.0 * power_mean(2);
    const double var_a = pi * pi / 16.0 * (power_mean(4) - power_mean(2) * power_mean(2));
    const double V = var_t * mean_a * mean_a + var_a * mean_t * mean_t + var_t * var_a;
    const double first[] = {var_a * mean_t * mean_t / V, var_t * mean_a * mean_a / V, 0.0};
    CHECK(volume["mean"].get<double>() == Approx(mean_t * mean_a).epsilon(0.01));
    CHECK(volume["variance"].get<double>() == Approx(V).epsilon(0.05));
    for (int i = 0; i < 3; ++i) {
        CHECK(volume["parameters"][i]["first"]["value"].get<double>() ==
              Approx(first[i]).margin(0.03));
    }
    CHECK(volume["parameters"][2]["total"]["value"] == 0.0);
    // Displacement and stress are proportional to the load over the thickness.
    for (const int q : {0, 1}) {
        CHECK(found["quantities"][q]["parameters"][1]["total"]["value"] > 0.3);
        CHECK(found["quantities"][q]["parameters"][2]["total"]["value"] > 0.1);
    }
    const Json fixed =
        run_json("rom sensitivity o/f.rom --samples 64 --fix load=20 --seed 3", folder.path());
    CHECK(fixed["quantities"][0]["parameters"].size() == 2);
    CHECK(value_of(fixed["fixed"], "load") == 20.0);
    const auto text = run_couture("rom sensitivity o/f.rom --samples 64", folder.path());
    CHECK_THAT(text.output, Contains("largest von Mises: mean") && Contains("320 evaluations"));
    const auto none =
        run_couture("rom sensitivity o/f.rom --fix load=20 --fix hole_radius=1 --fix thickness=1",
                    folder.path());
    CHECK(none.exit_code == 2);
    CHECK_THAT(none.errors, Contains("all parameters are fixed"));
}
