#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "io/atomic_file.h"
#include "tests/drivers/run_program.h"

using namespace couture;
using tests::run_couture;
using tests::TemporaryFolder;
using Json = nlohmann::json;

namespace {

const std::string bar = "'" COUTURE_SOURCE_DIR "/drivers/decks/solve_bar.toml'";

}  // namespace

TEST_CASE("couture: help and version", "[drivers]") {
    const TemporaryFolder folder;
    CHECK(run_couture("--version", folder.path()).output.starts_with("couture "));
    CHECK(run_couture("--help", folder.path()).exit_code == 0);
    CHECK(run_couture("solve --help", folder.path()).exit_code == 0);
}

TEST_CASE("couture: mistakes on the command line end with 2", "[drivers]") {
    const TemporaryFolder folder;
    const auto unknown = run_couture("slove x.toml", folder.path());
    CHECK(unknown.exit_code == 2);
    CHECK(unknown.errors.find("there is no command 'slove'") != std::string::npos);
    CHECK(unknown.errors.find("did you mean 'solve'?") != std::string::npos);
    CHECK(run_couture("", folder.path()).exit_code == 2);
    CHECK(run_couture("solve", folder.path()).exit_code == 2);
    CHECK(run_couture("solve x.toml --threads none", folder.path()).exit_code == 2);
    const auto missing = run_couture("solve x.toml", folder.path());
    CHECK(missing.exit_code == 2);
    CHECK(missing.errors == "couture: x.toml: can't be read: No such file or directory\n");
    const auto directory = run_couture("check .", folder.path());
    CHECK(directory.exit_code == 2);
    CHECK(directory.errors == "couture: .: is a folder, not a file\n");
}

TEST_CASE("couture check: a good deck is valid and nothing is written", "[drivers]") {
    const TemporaryFolder folder;
    const auto result = run_couture("check " + bar, folder.path());
    CHECK(result.exit_code == 0);
    CHECK(result.output == "solve_bar.toml: valid; patches 1, unknowns 162\n");
    CHECK(std::filesystem::is_empty(folder.path()));
}

TEST_CASE("couture solve: an expectation that is not met ends with 1", "[drivers]") {
    const TemporaryFolder folder;
    const auto result =
        run_couture("solve --json --set output.probe.0.expect=1 " + bar, folder.path());
    CHECK(result.exit_code == 1);
    CHECK(Json::parse(result.output)["status"] == "expectation_not_met");
}

TEST_CASE("couture solve: a body that can move ends with 2 and one object", "[drivers]") {
    const TemporaryFolder folder;
    const auto result = run_couture(
        "solve --json --set 'symmetry.0.on=[\"x_low\", \"y_low\"]' " + bar, folder.path());
    CHECK(result.exit_code == 2);
    CHECK(Json::parse(result.output)["status"] == "bad_input");
}

TEST_CASE("couture solve: more memory than there is ends with 1 before anything is made",
          "[drivers]") {
    const TemporaryFolder folder;
    const auto result =
        run_couture("solve " + bar + " --set discretization.elements=4000", folder.path());
    CHECK(result.exit_code == 1);
    CHECK(result.errors.find("unknowns takes about") != std::string::npos);
    CHECK(result.errors.find("take fewer 'elements' or a lower 'degree' in [discretization]") !=
          std::string::npos);
}

TEST_CASE("couture solve: results that can't be written end with 2 before the run", "[drivers]") {
    const TemporaryFolder folder;
    io::write_text(folder.path() / "taken", "a file");
    const auto result = run_couture("solve " + bar + " --out taken/results", folder.path());
    CHECK(result.exit_code == 2);
    CHECK(result.errors.find("taken/results: results can't be written there: ") !=
          std::string::npos);
    CHECK(result.errors.find("is not a folder") != std::string::npos);
    CHECK(result.errors.find("solving for") == std::string::npos);
}

TEST_CASE("couture solve: a disk that is full ends with 2 and leaves nothing half-written",
          "[drivers]") {
    const TemporaryFolder folder;
    // Blocks of 512 bytes: less than the field takes.
    const auto result = run_couture("solve --out results " + bar, folder.path(), "ulimit -f 8");
    CHECK(result.exit_code == 2);
    CHECK(result.errors.find(".vtu: can't be written: ") != std::string::npos);
    CHECK(result.errors.find("vtk") == std::string::npos);
    for (const auto& entry : std::filesystem::directory_iterator(folder.path() / "results")) {
        FAIL(entry.path());
    }
}

#ifndef __SANITIZE_ADDRESS__
TEST_CASE("couture: too little memory to start is said", "[drivers]") {
    const TemporaryFolder folder;
    const auto result = run_couture("solve --json " + bar, folder.path(), "ulimit -v 900000");
    CHECK(result.exit_code == 1);
    CHECK(result.errors.find("MB more (ulimit -v), it needs 1024 MB to start") !=
          std::string::npos);
    CHECK(Json::parse(result.output)["status"] == "failed");
}
#endif

TEST_CASE("couture: an expression that is not finite is found by check, with its place",
          "[drivers]") {
    const TemporaryFolder folder;
    io::write_text(folder.path() / "pole.toml",
                   "title = \"p\"\n[geometry]\npart = \"box\"\n[material.any]\nyoungs_modulus = "
                   "1e5\npoissons_ratio = 0.3\n[[fixed]]\non = \"x_low\"\n[[traction]]\non = "
                   "\"x_high\"\nx = \"1/(x-1)\"\n");
    const auto result = run_couture("check pole.toml", folder.path());
    CHECK(result.exit_code == 2);
    CHECK(result.errors.find("pole.toml:11: 'x' of [[traction]]: expression '1/(x-1)': is ") !=
          std::string::npos);
}

TEST_CASE("couture solve: a body that nothing loads is warned of", "[drivers]") {
    const TemporaryFolder folder;
    io::write_text(folder.path() / "idle.toml",
                   "title = \"p\"\n[geometry]\npart = \"box\"\n[material.any]\nyoungs_modulus = "
                   "1e5\npoissons_ratio = 0.3\n[[fixed]]\non = \"x_low\"\n[output]\nvtu = false\n");
    const auto result = run_couture("solve --json idle.toml", folder.path());
    CHECK(result.exit_code == 0);
    CHECK(Json::parse(result.output)["warnings"].at(0) ==
          "case 'default': nothing loads the body, its displacement is zero");
}

TEST_CASE("couture solve: an interpolated geometry is solved at a degree below its own",
          "[drivers]") {
    const TemporaryFolder folder;
    io::write_text(folder.path() / "ring.toml",
                   "[geometry]\npart = \"quarter_annulus_3d\"\n[discretization]\ndegree = "
                   "1\nelements = [1, 8, 1]\ngeometry = \"interpolated\"\n[material.any]\n"
                   "youngs_modulus = 1e5\npoissons_ratio = 0.3\n[[fixed]]\non = \"cut_y\"\n"
                   "[[traction]]\non = \"cut_x\"\nx = 1.0\n[output]\nvtu = false\n");
    const auto result = run_couture("solve --json ring.toml", folder.path());
    CHECK(result.exit_code == 0);
    const Json object = Json::parse(result.output);
    CHECK(object["unknowns"] == 3 * 2 * 9 * 2);
    // Chords of a Bezier arc with weight cos 45 degrees at eighths of its parameter.
    double area = 0.0;
    double previous = 0.0;
    for (int i = 1; i <= 8; ++i) {
        const double t = i / 8.0;
        const double angle = std::atan2(t * (1.0 - t) * std::sqrt(2.0) + t * t,
                                        (1.0 - t) * (1.0 - t) + t * (1.0 - t) * std::sqrt(2.0));
        area += 0.5 * (4.0 - 1.0) * std::sin(angle - previous);
        previous = angle;
    }
    CHECK(object["volume"].get<double>() == Approx(area).epsilon(1e-10));
    const auto exact =
        run_couture("solve --json ring.toml --set discretization.geometry=exact", folder.path());
    CHECK(exact.exit_code == 2);
    CHECK(exact.errors.find("refine: degree 1 is below degree 2 of the geometry") !=
          std::string::npos);
}

TEST_CASE("couture check: folds that no quadrature point sees are warned of", "[drivers]") {
    const TemporaryFolder folder;
    // The corner (1, 1) is pulled to where det J is barely negative there.
    io::write_text(folder.path() / "folded.txt",
                   "# nurbs mesh v.2.1\n2 2 1 0 0\nPATCH 1\n1 1\n2 2\n0 0 1 1\n0 0 1 1\n"
                   "0 1 0 0.49\n0 0 1 0.49\n1 1 1 1\n");
    io::write_text(folder.path() / "folded.toml",
                   "title = \"f\"\n[geometry]\nfile = \"folded.txt\"\n[geometry.sets]\n"
                   "west = [\"patch 0 side 0:low\"]\n[analysis]\nkinematics = "
                   "\"plane_strain\"\n[material.any]\nyoungs_modulus = 1.0\n"
                   "poissons_ratio = 0.3\n[[fixed]]\non = \"west\"\n");
    const auto result = run_couture("check folded.toml", folder.path());
    CHECK(result.exit_code == 0);
    CHECK(result.errors.find("patch 0 is folded: det J = ") != std::string::npos);
}

TEST_CASE("couture bench: sections by themselves, beside an earlier run", "[drivers]") {
    const TemporaryFolder folder;
    const auto first = run_couture("bench --quick --only products --save a.json", folder.path());
    REQUIRE(first.exit_code == 0);
    const auto json = nlohmann::json::parse(io::read_text(folder.path() / "a.json"));
    CHECK(json.at("assembly").empty());
    REQUIRE(json.at("products").size() >= 2);
    for (const auto& row : json.at("products")) {
        CHECK(row.at("matrix_seconds") > 0.0);
        CHECK(row.at("operator_seconds") > 0.0);
        CHECK(row.at("operator_bytes") > 0.0);
    }
    const auto second =
        run_couture("bench --quick --only products --compare a.json", folder.path());
    REQUIRE(second.exit_code == 0);
    CHECK_THAT(second.output, Catch::Contains("geometric mean of the ratios"));
    CHECK_THAT(second.output, Catch::Contains("degree 2, elements_per_direction 8, threads 1"));

    io::write_text(folder.path() / "b.json", "{\"a\": 1}");
    const auto wrong = run_couture("bench --quick --compare b.json", folder.path());
    CHECK(wrong.exit_code != 0);
    CHECK_THAT(wrong.errors, Catch::Contains("b.json: not the numbers of a benchmark"));
    const auto section = run_couture("bench --only prod", folder.path());
    CHECK(section.exit_code != 0);
}

TEST_CASE("couture bench: every line has a time and a share of the machine", "[drivers]") {
    const TemporaryFolder folder;
    const auto result = run_couture("bench --quick --json", folder.path());
    CHECK(result.exit_code == 0);
    const Json numbers = Json::parse(result.output);
    CHECK(numbers["machine"][0]["triad_bytes_per_second"] > 1e8);
    CHECK(numbers["assembly"].size() >= 4);
    for (const Json& row : numbers["assembly"]) {
        CHECK(row["seconds"] > 0.0);
        CHECK(row["flop"] > 0.0);
    }
    for (const Json& row : numbers["solution"]) {
        CHECK(row["residual"] <= 1e-8);
    }
    // None where there is no mpirun.
    for (const Json& row : numbers["ranks"]) {
        CHECK(row["iterations"] > 0);
        CHECK(row["solve_seconds"] > 0.0);
        const int n_ranks = row["ranks"];
        CHECK(row["unknowns_of_rank"].get<double>() <
              1.5 * row["unknowns"].get<double>() / n_ranks);
        CHECK((row["bytes_sent"] > 0.0) == (n_ranks > 1));
    }
    CHECK(numbers["cutting"].size() == 3);
    for (const Json& row : numbers["cutting"]) {
        CHECK(row["triangles"] > 1000);
        CHECK(row["loops_cpu_seconds"] > 0.0);
        CHECK(row["pants_cpu_seconds"] > 0.0);
    }
    CHECK(numbers["meshing"].size() == 3);
    for (const Json& row : numbers["meshing"]) {
        CHECK(row["patches"] == 4);
        CHECK(row["min_scaled_jacobian"] > 0.5);
        CHECK(row["cpu_seconds"] > 0.0);
    }
    REQUIRE(numbers["evaluation"].size() == 1);
    for (const char* phase : {"fields", "samples", "batch", "errors", "gradient"}) {
        CHECK(numbers["evaluation"][0][std::string(phase) + "_cpu_seconds"] > 0.0);
    }
}

TEST_CASE("couture solve: two runs are equal, two decks are not", "[drivers]") {
    const TemporaryFolder folder;
    REQUIRE(run_couture("solve --out a --threads 1 " + bar, folder.path()).exit_code == 0);
    REQUIRE(run_couture("solve --out b --threads 2 " + bar, folder.path()).exit_code == 0);
    REQUIRE(run_couture("solve --out c --set discretization.degree=3 " + bar, folder.path())
                .exit_code == 0);
    const std::string compare = "compare a/solve_bar.json ";
    CHECK(run_couture(compare + "b/solve_bar.json", folder.path()).output ==
          "equal within 1e-09\n");
    const auto no_number = run_couture(compare + "b/solve_bar.json --tolerance nan", folder.path());
    CHECK(no_number.exit_code == 2);
    const auto different = run_couture(compare + "c/solve_bar.json", folder.path());
    CHECK(different.exit_code == 1);
    CHECK(different.output.find("unknowns: 162") != std::string::npos);
}

TEST_CASE("couture convert: a deck's part becomes a file that info reads", "[drivers]") {
    const TemporaryFolder folder;
    REQUIRE(run_couture("convert " + bar + " bar.xml", folder.path()).exit_code == 0);
    const auto info = run_couture("info --json bar.xml", folder.path());
    REQUIRE(info.exit_code == 0);
    CHECK(Json::parse(info.output).is_object());
    CHECK(run_couture("compare bar.xml bar.xml", folder.path()).exit_code == 0);
}

TEST_CASE("couture convert: --refine halves elements and keeps the shape", "[drivers]") {
    const TemporaryFolder folder;
    REQUIRE(run_couture("convert " + bar + " bar.xml", folder.path()).exit_code == 0);
    REQUIRE(run_couture("convert bar.xml finer.xml --refine 1", folder.path()).exit_code == 0);
    const auto info_of = [&](const std::string& file) {
        return Json::parse(run_couture("info --json " + file, folder.path()).output);
    };
    const auto coarse = info_of("bar.xml");
    const auto fine = info_of("finer.xml");
    CHECK(coarse.at("/patches/0/elements"_json_pointer) == Json({1, 1, 1}));
    CHECK(fine.at("/patches/0/elements"_json_pointer) == Json({2, 2, 2}));
    CHECK(fine.at("volume").get<double>() == Approx(coarse.at("volume").get<double>()));
    const auto too_many = run_couture("convert finer.xml b.xml --refine 6", folder.path());
    CHECK(too_many.exit_code == 2);
    CHECK_THAT(too_many.errors, Catch::Contains("elements would be written"));
    const auto surface = run_couture("convert wheel wheel.stl --refine 1", folder.path());
    CHECK(surface.exit_code == 2);
    CHECK_THAT(surface.errors, Catch::Contains("--edge-length"));
}

TEST_CASE("couture: an interrupt ends with 130 and leaves no half-written file", "[drivers]") {
    const TemporaryFolder folder;
    const std::string deck = COUTURE_SOURCE_DIR "/drivers/decks/pipe_tee.toml";
    // Large enough to be still running after a second.
    const std::string run =
        "solve --set discretization.elements=16 --set discretization.degree=3 '" + deck +
        "' & pid=$!; sleep 1; kill -TERM $pid; wait $pid";
    const auto result = run_couture(run, folder.path());
    CHECK(result.exit_code == 130);
    CHECK(std::filesystem::is_empty(folder.path()));
}
