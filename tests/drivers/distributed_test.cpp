#include <catch2/catch.hpp>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "io/atomic_file.h"
#include "io/vtk_reader.h"
#include "tests/drivers/run_program.h"

namespace couture::tests {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

bool has_mpirun() {
    if (std::system("command -v mpirun >/dev/null 2>&1") == 0) {
        return true;
    }
    WARN("there is no mpirun: skipped");
    return false;
}

/// `run_couture` on several ranks.
ProgramResult run_on_ranks(int n_ranks, const std::string& arguments, const fs::path& folder,
                           const std::string& before = "true") {
    return run_couture(
        arguments, folder,
        before + "; export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1",
        "mpirun --oversubscribe -n " + std::to_string(n_ranks));
}

std::string deck_path(const std::string& name) {
    return std::string(COUTURE_SOURCE_DIR) + "/drivers/decks/" + name + ".toml";
}

/// What a run printed with --json.
Json summary_of(const ProgramResult& result) {
    INFO(result.errors);
    REQUIRE(result.exit_code == 0);
    return Json::parse(result.output);
}

void check_close(double a, double b, double scale, double tolerance) {
    CHECK(std::abs(a - b) <= tolerance * scale);
}

/// Energies, reactions and probes of two runs of one deck.
void check_equal_results(const Json& a, const Json& b, double tolerance) {
    CHECK(a["unknowns"] == b["unknowns"]);
    CHECK(a["elements"] == b["elements"]);
    REQUIRE(a["cases"].size() == b["cases"].size());
    // Of all cases: in one of them a body may shrink without any force.
    double energy = 0.0;
    double force_size = 0.0;
    for (const Json& x : a["cases"]) {
        energy = std::max(energy, std::abs(x["energy"].get<double>()));
        for (const auto& [set, force] : x["reactions"].items()) {
            for (const double f : force) {
                force_size = std::max(force_size, std::abs(f));
            }
        }
    }
    for (std::size_t c = 0; c < a["cases"].size(); ++c) {
        const Json& x = a["cases"][c];
        const Json& y = b["cases"][c];
        CAPTURE(x["name"]);
        check_close(x["energy"], y["energy"], energy, tolerance);
        for (const auto& [set, force] : x["reactions"].items()) {
            for (int k = 0; k < 3; ++k) {
                check_close(force[k], y["reactions"][set][k], force_size, tolerance);
            }
        }
    }
    for (std::size_t p = 0; p < a["probes"].size(); ++p) {
        const Json& x = a["probes"][p];
        CAPTURE(x["name"]);
        CHECK(b["probes"][p]["passed"] == x["passed"]);
        // Those that are expected to vanish have an absolute error that is allowed.
        const double allowed = x.value("allowed_error", 0.0);
        check_close(x["value"], b["probes"][p]["value"],
                    std::max({std::abs(x["value"].get<double>()), allowed, 1e-6}), 1e-4);
    }
}

}  // namespace

TEST_CASE("ranks: decks give what one process gives", "[ranks]") {
    if (!has_mpirun()) {
        return;
    }
    const std::string deck =
        GENERATE("solve_bar", "solve_cook", "solve_hollow_sphere", "solve_pipe_wall_heat",
                 "solve_plate_with_hole", "solve_thick_cylinder", "pipe_tee", "solve_le1");
    CAPTURE(deck);
    const TemporaryFolder folder;
    const Json one =
        summary_of(run_couture("solve " + deck_path(deck) + " --json --quiet", folder.path()));
    for (const char* solver : {"petsc", "matrix_free"}) {
        CAPTURE(solver);
        const Json four = summary_of(run_on_ranks(
            4, "solve " + deck_path(deck) + " --json --quiet --set solver.linear=" + solver,
            folder.path()));
        check_equal_results(one, four, 1e-6);
        CHECK(four["solver"]["name"] == solver);
        REQUIRE(four["ranks"]["unknowns"].size() == 4);
        double n = 0.0;
        for (const double owned : four["ranks"]["unknowns"]) {
            n += owned;
        }
        CHECK(n == four["unknowns"].get<double>());
    }
}

TEST_CASE("ranks: a hyperelastic run, stopped and resumed", "[ranks]") {
    if (!has_mpirun()) {
        return;
    }
    const TemporaryFolder folder;
    const std::string deck =
        deck_path("solve_rubber_block") + " --json --quiet --set solver.linear=auto";
    const Json one = summary_of(run_couture("solve " + deck, folder.path()));
    const Json three = summary_of(run_on_ranks(3, "solve " + deck + " --out ranks", folder.path()));
    CHECK(one["steps"] == three["steps"]);
    check_equal_results(one, three, 1e-6);
    CHECK(fs::exists(folder.path() / "ranks" / "states" / "rank_0002" / "0001.h5"));

    const fs::path states = folder.path() / "ranks" / "states";
    for (const char* rank : {"rank_0000", "rank_0001", "rank_0002"}) {
        for (const auto& state : fs::directory_iterator(states / rank)) {
            if (state.path().stem().string() > "0002") {
                fs::remove(state.path());
            }
        }
    }
    fs::remove(states / "rank_0001" / "0002.h5");
    const ProgramResult resumed =
        run_on_ranks(3, "solve " + deck + " --out ranks --resume", folder.path());
    check_equal_results(one, summary_of(resumed), 1e-6);
    CHECK(Json::parse(resumed.output)["history"].size() == one["history"].size());

    const ProgramResult other =
        run_on_ranks(2, "solve " + deck + " --out ranks --resume", folder.path());
    CHECK(other.exit_code != 0);
    CHECK_THAT(other.errors, Catch::Contains("rank"));
}

TEST_CASE("ranks: a pressure that follows the body", "[ranks]") {
    if (!has_mpirun()) {
        return;
    }
    const TemporaryFolder folder;
    const std::string deck = deck_path("solve_inflated_tube") + " --json --quiet";
    const Json one = summary_of(run_couture("solve " + deck, folder.path()));
    const Json three = summary_of(run_on_ranks(3, "solve " + deck, folder.path()));
    CHECK(one["steps"] == three["steps"]);
    check_equal_results(one, three, 1e-6);
}

TEST_CASE("ranks: pieces of the fields make the whole", "[ranks]") {
    if (!has_mpirun()) {
        return;
    }
    const TemporaryFolder folder;
    const std::string deck = deck_path("pipe_tee") + " --quiet";
    REQUIRE(run_couture("solve " + deck + " --out one", folder.path()).exit_code == 0);
    REQUIRE(run_on_ranks(3, "solve " + deck + " --out three", folder.path()).exit_code == 0);
    CHECK(fs::exists(folder.path() / "three" / "pipe_tee.pvtu"));
    const io::VtuMesh one = io::read_vtu(folder.path() / "one" / "pipe_tee.vtu");
    const io::VtuMesh three = io::read_vtu(folder.path() / "three" / "pipe_tee.pvtu");
    CHECK(one.cells.size() == three.cells.size());
    CHECK(std::set(one.cell_types.begin(), one.cell_types.end()) ==
          std::set(three.cell_types.begin(), three.cell_types.end()));
    const auto check_range = [](const MatrixX& a, const MatrixX& b) {
        REQUIRE(a.cols() == b.cols());
        const double size = a.cwiseAbs().maxCoeff();
        for (Eigen::Index k = 0; k < a.cols(); ++k) {
            check_close(a.col(k).minCoeff(), b.col(k).minCoeff(), size, 1e-5);
            check_close(a.col(k).maxCoeff(), b.col(k).maxCoeff(), size, 1e-5);
        }
    };
    check_range(one.points, three.points);
    REQUIRE(one.point_arrays.size() == three.point_arrays.size());
    for (std::size_t i = 0; i < one.point_arrays.size(); ++i) {
        CAPTURE(one.point_arrays[i].name);
        const auto same = std::find_if(
            three.point_arrays.begin(), three.point_arrays.end(),
            [&](const io::NamedRows& rows) { return rows.name == one.point_arrays[i].name; });
        REQUIRE(same != three.point_arrays.end());
        check_range(one.point_arrays[i].rows, same->rows);
    }
    for (const io::NamedRows& array : three.cell_arrays) {
        if (array.name == "patch") {
            CHECK(array.rows.maxCoeff() == 11.0);
        }
    }
}

TEST_CASE("ranks: what is wrong is said once and nothing hangs", "[ranks]") {
    if (!has_mpirun()) {
        return;
    }
    const TemporaryFolder folder;
    const auto fails = [&](int n_ranks, const std::string& arguments, const std::string& text) {
        const ProgramResult result =
            run_on_ranks(n_ranks, "solve " + arguments, folder.path(), "ulimit -t 120");
        CAPTURE(arguments, result.errors);
        CHECK(result.exit_code != 0);
        const std::size_t at = result.errors.find(text);
        REQUIRE(at != std::string::npos);
        CHECK(result.errors.find(text, at + 1) == std::string::npos);
    };
    const std::string bar = deck_path("solve_bar");
    fails(9, bar, "9 ranks for");
    fails(3, "missing.toml", "missing.toml");
    fails(3, bar + " --set solver.linear=cholmod", "works in one process");
    fails(3, bar + " --png", "pictures are drawn in one process");
    fails(2, bar + " --set material.steel.poissons_ratio=0.7", "is out of range");
    fails(3, bar + " --set solver.max_iterations=1", "after 1 iterations");
    fails(2, bar + " --set \"solver.petsc_options=-ksp_typ cg\"", "nothing reads the option");
    fails(3,
          deck_path("pipe_tee") +
              " --set \"fixed=[{on='branch_end',directions=['z']},"
              "{on='mid_plane',directions=['y']}]\" --set output.probe=[]",
          "free rigid-body motions");
}

}  // namespace couture::tests
