// Reduced models, from a deck to answers.
#include <algorithm>
#include <catch2/catch.hpp>
#include <chrono>
#include <nlohmann/json.hpp>

#include "io/atomic_file.h"
#include "rom/designs.h"
#include "tests/drivers/run_program.h"

using namespace couture;
using namespace couture::tests;
using Catch::Matchers::Contains;
using Json = nlohmann::json;

namespace {

namespace fs = std::filesystem;

const std::string model = R"(title = "Plate with a hole"
[geometry]
part = "plate_with_hole_3d"
[discretization]
elements = 3
[material.steel]
youngs_modulus = "210 GPa"
poissons_ratio = 0.3
[[symmetry]]
on = ["cut_x", "cut_y", "z_low"]
[[traction]]
on = "x_high"
value = [10, 0, 0]
)";

const std::string parameters = R"([[rom.parameter]]
key = "geometry.parameters.hole_radius"
range = [0.6, 1.4]
[[rom.parameter]]
name = "nu"
key = "material.steel.poissons_ratio"
range = [0.25, 0.33]
levels = 3
[[rom.parameter]]
name = "load"
key = "traction.0.value.0"
range = [5, 15]
factored = true
[[rom.parameter]]
name = "E"
key = "material.steel.youngs_modulus"
range = [200, 220]
unit = "GPa"
factored = true
)";

const std::string deck = model + "[rom]\ndesign = \"full\"\nsamples = 5\n" + parameters;

Json run_json(const std::string& arguments, const fs::path& folder) {
    const auto result = run_couture(arguments + " --json", folder);
    CAPTURE(arguments, result.errors);
    REQUIRE(result.exit_code == 0);
    return Json::parse(result.output);
}

// Contents of a folder by name, but for the times.
std::map<std::string, std::string> contents(const fs::path& folder) {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::directory_iterator(folder)) {
        if (entry.is_regular_file() && entry.path().filename() != "timings.csv") {
            files[entry.path().filename().string()] = io::read_text(entry.path());
        }
    }
    return files;
}

}  // namespace

TEST_CASE("rom: a model answers what the full solution says", "[drivers]") {
    const TemporaryFolder folder;
    io::write_text(folder.path() / "f.toml", deck);
    const Json trained = run_json("rom train f.toml --out o", folder.path());
    CHECK(trained["geometries"] == 5);
    CHECK(trained["materials"] == 3);
    CHECK(trained["loads"] == 1);
    CHECK(trained["solutions"] == 15);
    const Json validated = run_json("rom validate f.toml --out o -n 8 --galerkin", folder.path());
    CHECK(validated["errors"]["displacement"]["mean"] < 0.005);
    CHECK(validated["errors"]["displacement"]["worst"] < 0.02);
    CHECK(validated["errors"]["von_mises_max"]["mean"] < 0.03);
    CHECK(validated["errors"]["geometry"]["worst"] < 1e-3);
    const Json& learning = validated["error_by_geometries"];
    REQUIRE(learning.size() == 3);
    CHECK(learning.back()["error"] == validated["errors"]["displacement"]["mean"]);
    CHECK(learning.back()["error"] < learning.front()["error"]);
    // In the space of the modes the projection is the best in energy.
    CHECK(validated["galerkin_errors"]["displacement"]["worst"] < 0.02);
    // Factored parameters are exact: twice the load at half the modulus is four times as much.
    const Json one = run_json("rom eval o/f.rom --set load=5 --set E=220", folder.path());
    const Json other = run_json("rom eval o/f.rom --set load=10 --set 'E=220 GPa'", folder.path());
    CHECK(other["displacement_max"].get<double>() ==
          Approx(2.0 * one["displacement_max"].get<double>()).epsilon(1e-12));
    CHECK(other["von_mises_max"].get<double>() ==
          Approx(2.0 * one["von_mises_max"].get<double>()).epsilon(1e-12));
    const Json softer =
        run_json("rom eval o/f.rom --set load=10 --set 'E=200000 MPa'", folder.path());
    CHECK(softer["displacement_max"].get<double>() ==
          Approx(1.1 * other["displacement_max"].get<double>()).epsilon(1e-12));
    CHECK(softer["von_mises_max"].get<double>() ==
          Approx(other["von_mises_max"].get<double>()).epsilon(1e-9));
    const Json solved = run_json("rom eval o/f.rom --set hole_radius=0.9 --solve", folder.path());
    CHECK(solved["errors"]["displacement"] < 0.005);
    // The file alone answers, elsewhere.
    fs::create_directory(folder.path() / "elsewhere");
    fs::rename(folder.path() / "o/f.rom", folder.path() / "elsewhere/m.rom");
    fs::remove(folder.path() / "f.toml");
    const Json moved =
        run_json("rom eval elsewhere/m.rom --set hole_radius=0.9 --out v", folder.path());
    CHECK(moved["displacement_max"] == solved["displacement_max"]);
    CHECK(fs::exists(folder.path() / "v/m.vtu"));
}

TEST_CASE("rom: a deck without loads has a model of its geometry alone", "[drivers]") {
    const TemporaryFolder folder;
    std::string shape = model.substr(0, model.find("[[traction]]"));
    shape += "[rom]\ndesign = \"full\"\nsamples = 5\n" +
             parameters.substr(0, parameters.find("[[rom.parameter]]\nname"));
    io::write_text(folder.path() / "f.toml", shape);
    const auto trained = run_couture("rom train f.toml --out o", folder.path());
    REQUIRE(trained.exit_code == 0);
    CHECK_THAT(trained.output, Contains("5 geometries without loads"));
    CHECK_THAT(trained.output, !Contains("displacement"));
    const Json validated = run_json("rom validate f.toml --out o -n 4", folder.path());
    CHECK(validated["errors"]["geometry"]["worst"] < 1e-3);
    CHECK(validated["errors"]["displacement"]["worst"] == 0.0);
    const auto answer = run_couture("rom eval o/f.rom --set hole_radius=0.9", folder.path());
    CHECK_THAT(answer.output, Contains("geometry") && !Contains("von Mises"));
    const auto refused = run_couture("rom eval o/f.rom --galerkin", folder.path());
    CHECK(refused.exit_code == 2);
    CHECK_THAT(refused.errors, Contains("has geometry only"));
}

TEST_CASE("rom: stores and models are the same however the work was split", "[drivers]") {
    const TemporaryFolder folder;
    io::write_text(folder.path() / "f.toml", deck);
    REQUIRE(run_couture("rom train f.toml --jobs 1 --out a", folder.path()).exit_code == 0);
    REQUIRE(run_couture("rom train f.toml --jobs 2 --out b", folder.path()).exit_code == 0);
    // By shards in one folder.
    REQUIRE(run_couture("rom train f.toml --shard 2/2 --out c", folder.path()).exit_code == 0);
    REQUIRE(run_couture("rom train f.toml --out c", folder.path()).exit_code == 0);
    // Two shards apart, put together.
    REQUIRE(run_couture("rom train f.toml --shard 1/2 --out d1", folder.path()).exit_code == 0);
    REQUIRE(run_couture("rom train f.toml --shard 2/2 --out d2", folder.path()).exit_code == 0);
    const auto merged = run_couture("rom merge f.toml d1 d2 --out d", folder.path());
    REQUIRE(merged.exit_code == 0);
    CHECK_THAT(merged.output, Contains("15 of 15 solutions"));
    CHECK(run_couture("rom merge f.toml nowhere --out d", folder.path()).exit_code == 2);
    REQUIRE(run_couture("rom train f.toml --out d", folder.path()).exit_code == 0);
    const auto snapshots = contents(folder.path() / "a/snapshots");
    CHECK(snapshots.size() == 22);
    for (const char* other : {"b", "c", "d"}) {
        CAPTURE(other);
        CHECK((contents(folder.path() / other / "snapshots") == snapshots));
        CHECK((io::read_text(folder.path() / other / "f.rom") ==
               io::read_text(folder.path() / "a/f.rom")));
    }
}

TEST_CASE("rom: training that was killed at any moment goes on to the same bits", "[drivers]") {
    const TemporaryFolder folder;
    io::write_text(folder.path() / "f.toml", deck);
    const auto start = std::chrono::steady_clock::now();
    REQUIRE(run_couture("rom train f.toml --out a", folder.path()).exit_code == 0);
    const double seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const auto snapshots = contents(folder.path() / "a/snapshots");
    const std::string trained = io::read_text(folder.path() / "a/f.rom");
    // One moment in each tenth of the run.
    constexpr int n_moments = 10;
    const MatrixX moments = rom::random_design(1, n_moments, 20);
    int n_killed = 0;
    for (int i = 0; i < n_moments; ++i) {
        const std::string out = "k" + std::to_string(i);
        const double moment = seconds * (i + moments(i, 0)) / n_moments;
        const auto killed =
            run_couture("--version", folder.path(),
                        "exec timeout -s KILL " + std::to_string(moment) + " " + COUTURE_PROGRAM +
                            " rom train f.toml --quiet --out " + out);
        n_killed += killed.exit_code == 0 ? 0 : 1;
        CAPTURE(i, moment, killed.exit_code);
        const auto again = run_couture("rom train f.toml --out " + out, folder.path());
        CAPTURE(again.errors);
        REQUIRE(again.exit_code == 0);
        CHECK((contents(folder.path() / out / "snapshots") == snapshots));
        CHECK((io::read_text(folder.path() / out / "f.rom") == trained));
        CHECK(contents(folder.path() / out).size() == 1);
    }
    // Other programs may slow the first run down, the others not: not all need be cut.
    CHECK(n_killed >= n_moments / 2);
}

TEST_CASE("rom: projected displacements teach what more solutions would", "[drivers]") {
    const TemporaryFolder folder;
    const std::string few = model + "[rom]\ndesign = \"lhs\"\nsamples = 4\n";
    io::write_text(folder.path() / "few.toml", few + parameters);
    io::write_text(folder.path() / "f.toml", few + "projected = 9\n" + parameters);
    const auto error_of = [&](const std::string& name) {
        const Json trained = run_json("rom train " + name + ".toml --out " + name, folder.path());
        CHECK(trained["refused"].empty());
        return run_json("rom validate " + name + ".toml --out " + name + " -n 5",
                        folder.path())["errors"]["displacement"]["mean"]
            .get<double>();
    };
    CHECK(error_of("f") < 0.5 * error_of("few"));
    // The same bits by one process, by shards that wait for each other, and killed.
    const auto snapshots = contents(folder.path() / "f/snapshots");
    const auto require_same = [&](const std::string& out) {
        REQUIRE(run_couture("rom train f.toml --jobs 1 --out " + out, folder.path()).exit_code ==
                0);
        CHECK((contents(folder.path() / out / "snapshots") == snapshots));
    };
    require_same("one");
    const auto shard = [&](const std::string& part) {
        const auto run = run_couture("rom train f.toml --out s --shard " + part, folder.path());
        REQUIRE(run.exit_code == 0);
        return run.errors;
    };
    CHECK_THAT(shard("1/2"), Contains("after the 6 solutions of other shards"));
    CHECK_THAT(shard("2/2"), Contains("start the shards again") && !Contains("other shards"));
    CHECK_FALSE(fs::exists(folder.path() / "s/snapshots/solution_0004_00.h5"));
    CHECK_THAT(shard("1/2"), Contains("projecting onto"));
    CHECK(fs::exists(folder.path() / "s/snapshots/solution_0004_00.h5"));
    require_same("s");
    for (const std::string moment : {"0.3", "0.8", "1.3"}) {
        (void)run_couture("--version", folder.path(),
                          "exec timeout -s KILL " + moment + " " + COUTURE_PROGRAM +
                              " rom train f.toml --quiet --out k" + moment);
        require_same("k" + moment);
    }
}

TEST_CASE("rom: a killed process of several is named, and nothing is lost", "[drivers]") {
    const TemporaryFolder folder;
    io::write_text(folder.path() / "f.toml", deck);
    REQUIRE(run_couture("rom train f.toml --out a", folder.path()).exit_code == 0);
    // The program runs with a shell beside it that kills its youngest child as soon as there is
    // one.
    const auto result =
        run_couture("--version", folder.path(),
                    std::string(COUTURE_PROGRAM) +
                        " rom train f.toml --jobs 2 --out b & parent=$!; victim=; "
                        "while kill -0 $parent 2>/dev/null && test -z \"$victim\"; do "
                        "victim=$(ps -o pid= --ppid $parent | tail -n 1); done; "
                        "kill -9 $victim; wait $parent; exit $?; true");
    CAPTURE(result.errors);
    CHECK(result.exit_code == 1);
    CHECK_THAT(result.errors, Contains("of 2 ended with exit code 137 (signal 9)") &&
                                  Contains("the same command goes on from there"));
    CHECK_FALSE(fs::exists(folder.path() / "b/f.rom"));
    REQUIRE(run_couture("rom train f.toml --jobs 2 --out b", folder.path()).exit_code == 0);
    CHECK((contents(folder.path() / "b/snapshots") == contents(folder.path() / "a/snapshots")));
    CHECK((io::read_text(folder.path() / "b/f.rom") == io::read_text(folder.path() / "a/f.rom")));
}

TEST_CASE("rom: a full disk is an error, and nothing is lost", "[drivers]") {
    const TemporaryFolder folder;
    io::write_text(folder.path() / "f.toml", deck);
    REQUIRE(run_couture("rom train f.toml --out a", folder.path()).exit_code == 0);
    const auto snapshots = contents(folder.path() / "a/snapshots");
    const std::string trained = io::read_text(folder.path() / "a/f.rom");
    const std::size_t largest = std::max_element(snapshots.begin(), snapshots.end(),
                                                 [](const auto& one, const auto& other) {
                                                     return one.second.size() < other.second.size();
                                                 })
                                    ->second.size();
    REQUIRE(trained.size() > 1024 + largest);
    const auto run = [&](const std::string& command, std::size_t bytes) {
        // In blocks of 512 bytes.
        return run_couture(command, folder.path(), "ulimit -f " + std::to_string(bytes / 512));
    };
    // No room for the reference member.
    const auto first = run("rom train f.toml --out b", 1024);
    CHECK(first.exit_code == 2);
    CHECK_THAT(first.errors, Contains("b/snapshots/") && Contains("can't be written"));
    // With it, no room for solutions; then for them, but not for the model.
    fs::remove_all(folder.path() / "b");
    fs::create_directories(folder.path() / "b/snapshots");
    for (const char* name : {"plan.json", "reference.h5"}) {
        fs::copy(folder.path() / "a/snapshots" / name, folder.path() / "b/snapshots" / name);
    }
    const std::size_t small = snapshots.at("solution_0000_00.h5").size() - 512;
    const auto early = run("rom train f.toml --jobs 1 --out b", small);
    CAPTURE(early.errors);
    CHECK(early.exit_code == 2);
    CHECK_THAT(early.errors, Contains("b/snapshots/") && Contains("can't be written"));
    CHECK_FALSE(fs::exists(folder.path() / "b/f.rom"));
    const auto jobs = run("rom train f.toml --jobs 2 --out b", small);
    CAPTURE(jobs.errors);
    CHECK(jobs.exit_code == 1);
    CHECK_THAT(jobs.errors, Contains("can't be written") && Contains("what was made is kept"));
    const auto late = run("rom train f.toml --jobs 1 --out b", largest + 1024);
    CAPTURE(late.errors);
    CHECK(late.exit_code == 2);
    CHECK_THAT(late.errors, Contains("f.rom") && Contains("can't be written"));
    // No sample was refused for it, and no piece of a file is left.
    CHECK((contents(folder.path() / "b/snapshots") == snapshots));
    CHECK(contents(folder.path() / "b").empty());
    REQUIRE(run_couture("rom train f.toml --out b", folder.path()).exit_code == 0);
    CHECK((io::read_text(folder.path() / "b/f.rom") == trained));
    // The model that was there stays when another can't be written.
    const auto kept = run("rom validate f.toml --out b -n 2 --jobs 1", largest + 1024);
    CHECK(kept.exit_code == 2);
    CHECK((io::read_text(folder.path() / "b/f.rom") == trained));
}

TEST_CASE("rom: samples are added until the expected error is small", "[drivers]") {
    const TemporaryFolder folder;
    std::string coarse = deck;
    coarse.replace(coarse.find("samples = 5"), 11, "samples = 3");
    io::write_text(folder.path() / "f.toml", coarse);
    run_json("rom train f.toml", folder.path());
    const Json before = run_json("rom validate f.toml -n 6", folder.path());
    const auto enriched =
        run_couture("rom enrich f.toml --tolerance 1e-3 --max-points 8", folder.path());
    CAPTURE(enriched.errors, enriched.output);
    CHECK_THAT(enriched.output, Contains("geometries were added"));
    const Json after = run_json("rom validate f.toml -n 6", folder.path());
    CHECK(after["errors"]["displacement"]["worst"].get<double>() <
          0.5 * before["errors"]["displacement"]["worst"].get<double>());
    // What was added stays part of the model.
    const Json trained = run_json("rom train f.toml", folder.path());
    CHECK(trained["geometries"] > 3);
    CHECK(
        run_couture("rom enrich f.toml --tolerance 1e-9 --max-points 1", folder.path()).exit_code ==
        1);
}

TEST_CASE("rom: samples that can't be made are listed and left out", "[drivers]") {
    const TemporaryFolder folder;
    // A hole of radius 4 is as wide as the plate.
    std::string wide = deck;
    wide.replace(wide.find("[0.6, 1.4]"), 10, "[1.0, 4.0]");
    io::write_text(folder.path() / "f.toml", wide);
    const auto result = run_couture("rom train f.toml --json", folder.path());
    CHECK(result.exit_code == 1);
    const Json object = Json::parse(result.output);
    CHECK(object["status"] == "failed");
    CHECK(object["solutions"] == 12);
    REQUIRE(object["refused"].size() == 1);
    CHECK_THAT(object["refused"][0]["point"].get<std::string>(), Contains("hole_radius = 4"));
    CHECK_THAT(object["refused"][0]["reason"].get<std::string>(), Contains("half_width"));
    CHECK(fs::exists(folder.path() / "out/f/f.rom"));
    // It stays refused, and is tried again when that is asked for.
    const auto again = run_couture("rom train f.toml --retry", folder.path());
    CHECK(again.exit_code == 1);
    CHECK_THAT(again.errors, Contains("half_width"));
}

TEST_CASE("rom: what is wrong is said before anything is solved", "[drivers]") {
    const TemporaryFolder folder;
    const auto error_of = [&](const std::string& text,
                              const std::string& command = "rom train f.toml") {
        io::write_text(folder.path() / "f.toml", text);
        const auto result = run_couture(command, folder.path());
        CHECK(result.exit_code == 2);
        return result.errors;
    };
    CHECK_THAT(error_of(model), Contains("f.toml: has no section [rom]"));
    CHECK_THAT(error_of(deck + "[[traction]]\non = \"y_high\"\nvalue = [1, 0, 0]\n"),
               Contains("'load' can't be factored: not all loads are proportional to it"));
    const std::string push = "[[pressure]]\non = \"hole\"\nvalue = 1\ncase = ";
    CHECK_THAT(error_of(deck + push + "\"a\"\n" + push + "\"b\"\n"), Contains("2 load cases"));
    std::string two = deck;
    two.replace(two.find("plate_with_hole_3d"), 18, "plate_with_hole");
    two.replace(two.find(", \"z_low\""), 9, "");
    CHECK_THAT(error_of(two), Contains("reduced models are made of volumes"));
    CHECK_THAT(error_of(deck, "rom train f.toml --shard 3/2"), Contains("must read I/N"));
    std::string periodic = deck;
    periodic.replace(periodic.find("[0.6, 1.4]"), 10, "[0.6, 1.4]\nperiodic = true");
    for (const std::string command : {"rom train f.toml", "check f.toml"}) {
        CHECK_THAT(error_of(periodic, command),
                   Contains("'hole_radius' is periodic, but control points at 0.6 and 1.4 differ"));
    }
    CHECK_THAT(error_of(model + "[rom]\ndesign = \"full\"\nsamples = 1\n" + parameters),
               Contains("f.toml") && Contains("the design has 1 geometry"));
    CHECK_THAT(error_of(deck, "rom validate f.toml --out none"), Contains("there is no model"));
    const std::string projected = "[rom]\ndesign = \"full\"\nsamples = 3\nprojected = 2\n";
    CHECK_THAT(error_of(model.substr(0, model.find("[[traction]]")) + projected +
                        parameters.substr(0, parameters.find("[[rom.parameter]]\nname"))),
               Contains("'projected': the deck has no loads"));
    CHECK_THAT(
        error_of(model + projected + parameters.substr(parameters.find("[[rom.parameter]]\nname"))),
        Contains("'projected' adds geometries, but no parameter changes the geometry"));
}

TEST_CASE("rom: check says what would be solved, and where there are no members", "[drivers]") {
    const TemporaryFolder folder;
    io::write_text(folder.path() / "f.toml", deck);
    const auto checked = run_couture("check f.toml", folder.path());
    CHECK(checked.exit_code == 0);
    CHECK_THAT(checked.output, Contains("5 geometries x 1 loads x 3 materials = 15 snapshots"));
    CHECK_THAT(checked.errors, !Contains("there is no member"));
    std::string wide = deck;
    wide.replace(wide.find("[0.6, 1.4]"), 10, "[0.6, 4.5]");
    io::write_text(folder.path() / "f.toml", wide);
    const auto warned = run_couture("check f.toml", folder.path());
    CHECK(warned.exit_code == 0);
    CHECK_THAT(warned.errors, Contains("there is no member at hole_radius = 4.5"));
    // Shapes alone need no supports.
    std::string shape = model.substr(0, model.find("[[symmetry]]"));
    shape += "[rom]\ndesign = \"full\"\nsamples = 5\n" +
             parameters.substr(0, parameters.find("[[rom.parameter]]\nname"));
    io::write_text(folder.path() / "f.toml", shape);
    CHECK(run_couture("check f.toml", folder.path()).exit_code == 0);
}

TEST_CASE("rom: exports overwrite nothing of another kind", "[drivers]") {
    const TemporaryFolder folder;
    io::write_text(folder.path() / "f.toml", deck);
    REQUIRE(run_couture("rom train f.toml --out o", folder.path()).exit_code == 0);
    for (const std::string option : {"--binary a.html", "--binary o/f.rom", "--html a.bin"}) {
        CAPTURE(option);
        const auto result = run_couture("rom export o/f.rom " + option, folder.path());
        CHECK(result.exit_code == 2);
    }
    CHECK(run_couture("rom eval o/f.rom", folder.path()).exit_code == 0);
}

TEST_CASE("rom: answers outside of the box are marked, models of other files refused",
          "[drivers]") {
    const TemporaryFolder folder;
    io::write_text(folder.path() / "f.toml", deck);
    REQUIRE(run_couture("rom train f.toml --out o", folder.path()).exit_code == 0);
    const auto near = run_couture("rom eval o/f.rom --set hole_radius=1.5", folder.path());
    CHECK(near.exit_code == 0);
    CHECK_THAT(near.errors, Contains("hole_radius = 1.5 lies outside of [0.6, 1.4]"));
    const auto far = run_couture("rom eval o/f.rom --set hole_radius=1.7", folder.path());
    CHECK(far.exit_code == 2);
    CHECK_THAT(far.errors, Contains("--force"));
    CHECK(run_couture("rom eval o/f.rom --set hole_radius=1.7 --force", folder.path()).exit_code ==
          0);
    CHECK_THAT(run_couture("rom eval o/f.rom --set radius=1", folder.path()).errors,
               Contains("no parameter is called 'radius'"));
    CHECK_THAT(run_couture("rom eval o/f.rom --set 'E=200 mm'", folder.path()).errors,
               Contains("is a length, not a pressure"));
    CHECK_THAT(run_couture("rom eval o/f.rom --set E=stiff", folder.path()).errors,
               Contains("is no number"));
    // A store of another deck.
    std::string other = deck;
    other.replace(other.find("0.33"), 4, "0.34");
    io::write_text(folder.path() / "f.toml", other);
    const auto refused = run_couture("rom train f.toml --out o", folder.path());
    CHECK(refused.exit_code == 2);
    CHECK_THAT(refused.errors, Contains("of another job: 'parameters' differs"));
    // A damaged model.
    std::string bytes = io::read_text(folder.path() / "o/f.rom");
    io::write_text(folder.path() / "cut.rom", bytes.substr(0, bytes.size() / 2));
    const auto cut = run_couture("rom eval cut.rom", folder.path());
    CHECK(cut.exit_code == 2);
    CHECK_THAT(cut.errors, Contains("cut or changed"));
}
