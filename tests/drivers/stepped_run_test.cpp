#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "io/atomic_file.h"
#include "tests/drivers/run_program.h"

using namespace couture;
using tests::run_couture;
using tests::TemporaryFolder;
using Json = nlohmann::json;
using Catch::Matchers::Contains;

namespace fs = std::filesystem;

namespace {

/// A block that is stretched in ten equal steps.
const std::string block = R"(title = "Block"
[geometry]
part = "box"
[discretization]
degree = 2
elements = 2
[material.rubber]
model = "neo_hookean"
shear_modulus = 3.0
bulk_modulus = 20.0
[[symmetry]]
on = ["x_low", "y_low", "z_low"]
[[displacement]]
on = "x_high"
x = 0.5
[stepping]
first_step = 0.1
largest_step = 0.1
[[output.probe]]
quantity = "stress_xx"
at = [0.5, 0.5, 0.5]
expect = 4.1282217920
tolerance = 1e-8
)";

/// A path without end: the moving face would pass through the held one.
const std::string impossible =
    "--set displacement.0.x=-1.5 --set stepping.smallest_step=5e-3 "
    "--set output.probe=[]";

/// A half seal of rubber that is pushed flat in ten steps and meshed again half way.
///
/// @param geometry  what stands in [geometry]
/// @param cuts      the set or sets that are held
/// @param more      further lines of [remeshing], then further sections
std::string half_seal_deck(const std::string& geometry, const std::string& cuts,
                           const std::string& more) {
    return "[geometry]\n" + geometry + R"(
[material.rubber]
model = "neo_hookean"
shear_modulus = 3
bulk_modulus = 20
[[fixed]]
on = )" + cuts +
           R"(
[[displacement]]
on = "cap"
value = [-20, 0, 0]
[stepping]
first_step = 0.1
largest_step = 0.1
[remeshing]
at = [0.5]
)" + more;
}

const std::string by_surface = "mesher = \"surface\"\n";

void write_deck(const TemporaryFolder& folder, const std::string& text = block) {
    io::write_text(folder.path() / "block.toml", text);
}

Json summary_of(const TemporaryFolder& folder, const std::string& out) {
    return Json::parse(io::read_text(folder.path() / out / "block.json"));
}

std::vector<std::string> names_in(const fs::path& folder) {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder)) {
        names.push_back(entry.path().filename().string());
    }
    std::sort(names.begin(), names.end());
    return names;
}

/// The states and fields of two runs are equal, byte for byte.
void check_equal(const TemporaryFolder& folder, const std::string& a, const std::string& b) {
    for (const std::string& sub : {std::string("."), std::string("states")}) {
        const auto names = names_in(folder.path() / a / sub);
        CHECK(names == names_in(folder.path() / b / sub));
        for (const std::string& name : names) {
            const fs::path file = fs::path(sub) / name;
            if (fs::is_regular_file(folder.path() / a / file) && name != "block.json") {
                CAPTURE(name);
                CHECK((io::read_text(folder.path() / a / file) ==
                       io::read_text(folder.path() / b / file)));
            }
        }
    }
    const Json first = summary_of(folder, a);
    const Json second = summary_of(folder, b);
    for (const char* key : {"history", "probes", "cases", "steps", "cuts", "finished"}) {
        CAPTURE(key);
        CHECK(first[key] == second[key]);
    }
}

}  // namespace

TEST_CASE("couture solve: a hyperelastic deck writes a series", "[drivers]") {
    const TemporaryFolder folder;
    write_deck(folder);
    const auto result =
        run_couture("solve block.toml --out a --set output.every=4 --set output.gauss_points=true",
                    folder.path());
    CAPTURE(result.errors);
    CHECK(result.exit_code == 0);
    CHECK_THAT(result.errors, Contains("step 3: t = 0.3 of 1, step 0.1, "));
    CHECK_THAT(result.output, Contains("steps 10, cuts 0, Newton iterations"));
    CHECK(names_in(folder.path() / "a") ==
          std::vector<std::string>{"block.json", "block.pvd", "block_0004.vtu", "block_0008.vtu",
                                   "block_0010.vtu", "block_gauss.pvd", "block_gauss_0004.vtu",
                                   "block_gauss_0008.vtu", "block_gauss_0010.vtu", "states"});
    CHECK(names_in(folder.path() / "a/states").size() == 10);
    CHECK_THAT(io::read_text(folder.path() / "a/block.pvd"),
               Contains("<DataSet timestep=\"1\" file=\"block_0010.vtu\"/>"));
    const Json summary = summary_of(folder, "a");
    CHECK(summary["finished"] == true);
    CHECK(summary["history"].size() == 10);
    CHECK(summary["history"][9]["t"] == 1.0);
    CHECK(summary["cases"][0]["balance"].get<double>() < 1e-8);
}

TEST_CASE("couture solve --resume: an ended run is written again", "[drivers]") {
    const TemporaryFolder folder;
    write_deck(folder);
    REQUIRE(run_couture("solve block.toml --out a", folder.path()).exit_code == 0);
    fs::copy(folder.path() / "a", folder.path() / "b", fs::copy_options::recursive);
    fs::remove(folder.path() / "b/block_0003.vtu");
    fs::remove(folder.path() / "b/block.pvd");
    const auto again = run_couture("solve block.toml --out b --resume", folder.path());
    CHECK(again.exit_code == 0);
    CHECK_THAT(again.errors, Contains("the run had already ended at t = 1"));
    check_equal(folder, "a", "b");
}

TEST_CASE("couture solve --resume: as if the run had not stopped", "[drivers]") {
    const TemporaryFolder folder;
    write_deck(folder);
    REQUIRE(run_couture("solve block.toml --out a", folder.path()).exit_code == 0);
    fs::copy(folder.path() / "a", folder.path() / "b", fs::copy_options::recursive);
    for (const char* state : {"0005", "0006", "0007", "0008", "0009", "0010"}) {
        fs::remove(folder.path() / "b/states" / (std::string(state) + ".h5"));
    }
    // The newest is cut: the one before is taken.
    const fs::path newest = folder.path() / "b/states/0004.h5";
    io::write_text(newest, io::read_text(newest).substr(0, 3000));
    const auto rest = run_couture("solve block.toml --out b --resume", folder.path());
    CHECK(rest.exit_code == 0);
    CHECK_THAT(rest.errors, Contains("states/0004.h5: size and hash are") &&
                                Contains("; this state is left out"));
    CHECK_THAT(rest.errors, Contains("resumed at t = 0.3 after step 3"));
    check_equal(folder, "a", "b");
}

TEST_CASE("couture solve --resume: killed at any moment", "[drivers]") {
    const TemporaryFolder folder;
    write_deck(folder);
    REQUIRE(run_couture("solve block.toml --out a", folder.path()).exit_code == 0);
    // As soon as one of these is there.
    for (const char* moment :
         {"block_0001.vtu", "states/0003.h5", "block_0006.vtu", "block.json"}) {
        CAPTURE(moment);
        fs::remove_all(folder.path() / "b");
        static_cast<void>(run_couture(
            fmt::format("solve block.toml --out b & pid=$!; while [ ! -e b/{} ]; do sleep 0.002; "
                        "done; kill -KILL $pid; wait $pid",
                        moment),
            folder.path()));
        const auto rest = run_couture("solve block.toml --out b --resume", folder.path());
        CAPTURE(rest.errors);
        CHECK(rest.exit_code == 0);
        CHECK(rest.errors.find("left out") == std::string::npos);
        check_equal(folder, "a", "b");
    }
}

TEST_CASE("couture solve --resume: states of another deck are refused", "[drivers]") {
    const TemporaryFolder folder;
    write_deck(folder);
    REQUIRE(run_couture("solve block.toml --out a", folder.path()).exit_code == 0);
    const auto other = run_couture(
        "solve block.toml --out a --resume --set material.rubber.shear_modulus=4", folder.path());
    CHECK(other.exit_code == 2);
    CHECK_THAT(other.errors, Contains("states/0001.h5: is a state of another deck: model hash "));
    CHECK(names_in(folder.path() / "a/states").size() == 10);
    const auto steps = run_couture(
        "solve block.toml --out a --resume --set stepping.largest_step=0.2", folder.path());
    CHECK(steps.exit_code == 0);
}

TEST_CASE("couture solve: without --resume old states go", "[drivers]") {
    const TemporaryFolder folder;
    write_deck(folder);
    REQUIRE(run_couture("solve block.toml --out a", folder.path()).exit_code == 0);
    const auto again = run_couture(
        "solve block.toml --out a --set stepping.first_step=0.5 --set stepping.largest_step=0.5",
        folder.path());
    CHECK(again.exit_code == 0);
    CHECK_THAT(again.errors, Contains("states: 10 states of an earlier run removed"));
    CHECK(names_in(folder.path() / "a/states") == std::vector<std::string>{"0001.h5", "0002.h5"});
    CHECK_FALSE(fs::exists(folder.path() / "a/block_0003.vtu"));
}

TEST_CASE("couture solve: a deck that can't run leaves the results of an earlier one",
          "[drivers]") {
    const TemporaryFolder folder;
    write_deck(folder);
    REQUIRE(run_couture("solve block.toml --out a", folder.path()).exit_code == 0);
    const std::vector<std::string> before = names_in(folder.path() / "a/states");
    REQUIRE(before.size() == 10);
    const auto wrong = run_couture("solve block.toml --out a --set displacement.0.x='\"sqrt(-t)\"'",
                                   folder.path());
    CHECK(wrong.exit_code == 2);
    CHECK(names_in(folder.path() / "a/states") == before);
    CHECK(fs::exists(folder.path() / "a/block.pvd"));
}

TEST_CASE("couture solve --resume: states under a wrong name and gaps are told", "[drivers]") {
    const TemporaryFolder folder;
    write_deck(folder);
    REQUIRE(run_couture("solve block.toml --out a", folder.path()).exit_code == 0);
    fs::remove(folder.path() / "a/states/0005.h5");
    fs::copy_file(folder.path() / "a/states/0003.h5", folder.path() / "a/states/0010.h5",
                  fs::copy_options::overwrite_existing);
    const auto resumed = run_couture("solve block.toml --out a --resume", folder.path());
    CHECK(resumed.exit_code == 0);
    CHECK_THAT(resumed.errors,
               Contains("0010.h5: holds step 3, not the one that it is named after") &&
                   Contains("the states of steps 5 to 5 are missing") &&
                   Contains("resumed at t = 0.9"));
}

TEST_CASE("couture solve: a load that is too large ends with 1 and keeps its steps", "[drivers]") {
    const TemporaryFolder folder;
    write_deck(folder);
    const auto result = run_couture("solve block.toml --json --out a " + impossible, folder.path());
    CHECK(result.exit_code == 1);
    CHECK_THAT(result.errors, Contains("the run did not reach its end: no equilibrium") &&
                                  Contains("go on with --resume"));
    const Json summary = Json::parse(result.output);
    CHECK(summary["status"] == "not_finished");
    CHECK(summary["finished"] == false);
    CHECK_THAT(summary["reason"].get<std::string>(), Contains("no equilibrium"));
    CHECK(summary["cuts"] > 0);
    const std::size_t n_steps = summary["history"].size();
    CHECK(n_steps > 4);
    CHECK(names_in(folder.path() / "a/states").size() == n_steps);
    // Another try stops at the same place and counts the steps of both.
    const auto again =
        run_couture("solve block.toml --json --resume --out a " + impossible, folder.path());
    CHECK(again.exit_code == 1);
    CHECK(Json::parse(again.output)["history"].size() == n_steps);
}

TEST_CASE("couture solve: a disk that fills during the series ends with 1 and keeps its steps",
          "[drivers]") {
    const TemporaryFolder folder;
    write_deck(folder);
    REQUIRE(run_couture("solve block.toml --out a", folder.path()).exit_code == 0);
    // The first states fit, a field does not: files of at most so many blocks of 512 bytes.
    const auto full = run_couture("solve block.toml --json --out b", folder.path(), "ulimit -f 8");
    CHECK(full.exit_code == 1);
    CHECK_THAT(full.errors, Contains("block_0001.vtu: can't be written: ") &&
                                Contains("0 steps until t = 0 are kept in b/states"));
    // A folder in the way of the fourth state.
    fs::create_directories(folder.path() / "c/states/0004.h5/x");
    const auto blocked = run_couture("solve block.toml --out c --resume", folder.path());
    CHECK(blocked.exit_code == 1);
    CHECK_THAT(blocked.errors, Contains("0004.h5: is a folder") &&
                                   Contains("3 steps until t = 0.3 are kept in c/states"));
    fs::remove_all(folder.path() / "c/states/0004.h5");
    CHECK(run_couture("solve block.toml --out c --resume", folder.path()).exit_code == 0);
    check_equal(folder, "a", "c");
}

TEST_CASE("couture solve: --resume is for hyperelastic decks", "[drivers]") {
    const TemporaryFolder folder;
    const auto result = run_couture(
        "solve --resume '" COUTURE_SOURCE_DIR "/drivers/decks/solve_bar.toml'", folder.path());
    CHECK(result.exit_code == 2);
    CHECK_THAT(result.errors, Contains("--resume goes on from the states of a hyperelastic run"));
}

TEST_CASE("couture solve: probes at a time, also after a resume", "[drivers]") {
    const TemporaryFolder folder;
    write_deck(folder, half_seal_deck("part = \"half_seal\"", "\"cuts\"", R"([discretization]
degree = 1
geometry = "interpolated"
[output]
every = 4
[[output.probe]]
quantity = "displacement_x"
at = [65, 1, 2]
expect = -20
tolerance = 1e-9
)"));
    const std::string run = "solve block.toml";
    const auto result = run_couture(run + " --out a", folder.path());
    CAPTURE(result.output, result.errors);
    REQUIRE(result.exit_code == 0);
    CHECK_THAT(result.errors, Contains("meshed again at t = 0.5 (time), "));
    CHECK_THAT(result.output, Contains("remeshings 1") && Contains("worst shape ratio"));
    CHECK(names_in(folder.path() / "a") ==
          std::vector<std::string>{"block.json", "block.pvd", "block_0004.vtu",
                                   "block_0005_remeshed.vtu", "block_0008.vtu", "block_0010.vtu",
                                   "states"});
    const Json summary = summary_of(folder, "a");
    REQUIRE(summary["history"].size() == 11);
    CHECK(summary["steps"] == 10);
    CHECK(summary["remeshings"] == 1);
    const Json report = summary["history"][5]["remeshing"];
    CHECK(report["energy"]["after"].get<double>() ==
          Approx(report["energy"]["before"].get<double>()).epsilon(0.02));
    CHECK(report["transfer"] == "displacement");
    CHECK(report["shape_ratio"]["after"] < report["shape_ratio"]["before"]);
    // From before the remeshing, and from after it.
    for (const char* last : {"0005.h5", "0005_remeshed.h5", "0007.h5"}) {
        CAPTURE(last);
        fs::remove_all(folder.path() / "b");
        fs::copy(folder.path() / "a", folder.path() / "b", fs::copy_options::recursive);
        for (const std::string& name : names_in(folder.path() / "b/states")) {
            // "0005.h5" is less than "0005_remeshed.h5".
            if (name > last) {
                fs::remove(folder.path() / "b/states" / name);
            }
        }
        REQUIRE(run_couture(run + " --out b --resume", folder.path()).exit_code == 0);
        check_equal(folder, "a", "b");
    }
}

TEST_CASE("couture solve: from triangles to a run that is meshed again from its surface",
          "[drivers]") {
    const TemporaryFolder folder;
    const auto meshed = run_couture(
        "mesh half_seal --open caps --stage volume --degree 1 --element-size 8", folder.path());
    CAPTURE(meshed.output, meshed.errors);
    REQUIRE(meshed.exit_code == 0);
    write_deck(folder, half_seal_deck("file = \"out/half_seal/half_seal_volume.xml\"",
                                      "[\"cut_low\", \"cut_high\"]", by_surface));
    const auto result = run_couture("solve block.toml --out a", folder.path());
    CAPTURE(result.output, result.errors);
    REQUIRE(result.exit_code == 0);
    CHECK_THAT(result.errors, Contains("new mesh: from ") && Contains("meshed again at t = 0.5"));
    const Json summary = summary_of(folder, "a");
    CHECK(summary["remeshings"] == 1);
    const Json report = summary["history"][5]["remeshing"];
    CHECK(report["energy"]["after"].get<double>() ==
          Approx(report["energy"]["before"].get<double>()).epsilon(0.02));
    CHECK(report["volume"]["after"].get<double>() ==
          Approx(report["volume"]["before"].get<double>()).epsilon(0.01));
    // The sets are those of the first mesh.
    CHECK(report["reactions_after"].size() == 3);
    CHECK(report["reactions_before"].size() == 3);

    write_deck(folder, half_seal_deck("part = \"half_seal\"", "\"cuts\"", by_surface));
    const auto exact = run_couture("solve block.toml --out b", folder.path());
    CHECK(exact.exit_code == 2);
    CHECK_THAT(exact.errors, Contains("mesher = \"surface\"") && Contains("has weights") &&
                                 Contains("mesher = \"slide\""));
}

TEST_CASE("couture solve: meshed again from its surface, the worst element is better by 30 %",
          "[drivers]") {
    const TemporaryFolder folder;
    write_deck(folder, half_seal_deck("part = \"half_seal\"\nparameters.divisions = 2", "\"cuts\"",
                                      by_surface + R"([discretization]
degree = 1
geometry = "interpolated"
)"));
    // To 13.3 mm in four steps.
    const std::string run =
        "solve block.toml --set displacement.0.value=[-14,0,0] --set stepping.first_step=0.25 "
        "--set stepping.largest_step=0.25 --set remeshing.at=[0.95] "
        "--set material.rubber.bulk_modulus=";
    const auto kappa = GENERATE(as<std::string>{}, "20", "10");
    CAPTURE(kappa);
    const auto result = run_couture(run + kappa + " --out a", folder.path());
    CAPTURE(result.output, result.errors);
    REQUIRE(result.exit_code == 0);
    const Json summary = summary_of(folder, "a");
    REQUIRE(summary["remeshings"] == 1);
    const Json report = summary["history"][4]["remeshing"];
    const auto part_left = [&](const char* key) {
        return report[key]["after"].get<double>() / report[key]["before"].get<double>();
    };
    CHECK(part_left("shape_ratio") < 0.7);
    CHECK(part_left("scaled_jacobian") > 0.97);
    CHECK(part_left("energy") == Approx(1.0).epsilon(0.01));
    CHECK(part_left("volume") == Approx(1.0).epsilon(0.002));
    CHECK(report["reactions_after"]["cap"][0].get<double>() ==
          Approx(report["reactions_before"]["cap"][0].get<double>()).epsilon(0.01));
    CHECK(report["iterations"].get<int>() <= 4);
}
