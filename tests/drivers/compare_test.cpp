#include <catch2/catch.hpp>
#include <limits>
#include <nlohmann/json.hpp>

#include "drivers/comparison.h"
#include "io/atomic_file.h"
#include "tests/drivers/run_program.h"

using namespace couture;
using namespace couture::drivers;
using namespace couture::tests;
using Catch::Matchers::Contains;

namespace {

const std::string bar = "'" COUTURE_SOURCE_DIR "/drivers/decks/solve_bar.toml'";

/// One square of VTK's kind 9 in the x-y plane, 3 x 4.
io::VtuMesh square() {
    MatrixX points(4, 3);
    points << 0, 0, 0, 3, 0, 0, 3, 4, 0, 0, 4, 0;
    return {points,
            {9},
            {{0, 1, 2, 3}},
            {{"heat", VectorX::LinSpaced(4, 1.0, 4.0)}},
            {{"patch", VectorX::Zero(1)}},
            "{\"deck_hash\": \"1\"}"};
}

}  // namespace

TEST_CASE("compare_vtu: equal meshes and values have no differences", "[drivers]") {
    io::VtuMesh close = square();
    close.points(2, 0) += 4e-3;
    close.point_arrays[0].rows(1) += 3e-3;
    const VtuComparison comparison = compare_vtu(square(), close, 1e-3);
    CHECK(comparison.differences.empty());
    CHECK(comparison.provenance.empty());
}

TEST_CASE("compare_vtu: the largest difference and its place are named", "[drivers]") {
    io::VtuMesh other = square();
    other.point_arrays[0].rows(0) += 0.01;
    other.point_arrays[0].rows(2) += 0.1;
    other.provenance = "{\"deck_hash\": \"2\"}";
    const VtuComparison comparison = compare_vtu(square(), other, 1e-3);
    REQUIRE(comparison.differences.size() == 1);
    CHECK(comparison.differences[0] ==
          "point array 'heat': 2 of 4 rows differ, most 3, 3.1 (2.50e-02 of its largest value) in "
          "component 0 at (3, 4, 0)");
    CHECK(comparison.provenance == std::vector<std::string>{"deck_hash: \"1\", \"2\""});
}

TEST_CASE("compare_vtu: moved points, values in cells, NaN", "[drivers]") {
    io::VtuMesh moved = square();
    moved.points(1, 2) = 0.5;
    CHECK(compare_vtu(square(), moved, 1e-3).differences ==
          std::vector<std::string>{"positions: 1 of 4 points differ, most 0.5 (9.95e-02 of the "
                                   "part's size) at (3, 0, 0)"});
    io::VtuMesh cells = square();
    cells.cell_arrays[0].rows(0) = 2.0;
    CHECK_THAT(compare_vtu(square(), cells, 1e-3).differences.at(0),
               Contains("cell array 'patch': 1 of 1 rows differ") && Contains("at (1.5, 2, 0)"));
    io::VtuMesh broken = square();
    broken.point_arrays[0].rows(1) = std::numeric_limits<double>::quiet_NaN();
    CHECK_THAT(compare_vtu(square(), broken, 1e-3).differences.at(0), Contains("1 of 4 rows"));
    CHECK(compare_vtu(broken, broken, 1e-3).differences.empty());
}

TEST_CASE("compare_vtu: other meshes and arrays that one file lacks", "[drivers]") {
    io::VtuMesh other = square();
    other.cells[0] = {1, 2, 3, 0};
    other.point_arrays[0].name = "cold";
    other.cell_arrays[0].rows = MatrixX::Zero(1, 3);
    CHECK(compare_vtu(square(), other, 1e-3).differences ==
          std::vector<std::string>{"cell 0: has other points, or the same in another order",
                                   "point array 'heat': only in the first",
                                   "point array 'cold': only in the second",
                                   "cell array 'patch': 1 components, 3 components"});
}

TEST_CASE("couture compare: fields of two runs", "[drivers]") {
    const TemporaryFolder folder;
    REQUIRE(run_couture("solve --out a " + bar, folder.path()).exit_code == 0);
    REQUIRE(
        run_couture("solve --out b --set material.steel.youngs_modulus=100e9 " + bar, folder.path())
            .exit_code <= 1);
    const auto same =
        run_couture("compare a/solve_bar_pull.vtu a/solve_bar_pull.vtu", folder.path());
    CHECK(same.output == "equal within 1e-09\n");
    const auto different =
        run_couture("compare --json a/solve_bar_pull.vtu b/solve_bar_pull.vtu", folder.path());
    CHECK(different.exit_code == 1);
    const auto answer = nlohmann::json::parse(different.output);
    CHECK(answer["status"] == "different");
    CHECK_THAT(answer["differences"].at(0).get<std::string>(),
               Contains("point array 'displacement'"));
    CHECK(answer["provenance"].size() == 2);
}

TEST_CASE("couture compare: two kinds, damaged fields", "[drivers]") {
    const TemporaryFolder folder;
    REQUIRE(run_couture("solve --out a " + bar, folder.path()).exit_code == 0);
    const std::string field = "compare a/solve_bar_pull.vtu ";
    const auto kinds = run_couture(field + "a/solve_bar.json", folder.path());
    CHECK(kinds.exit_code == 2);
    CHECK_THAT(kinds.errors, Contains("are not of one kind"));

    const std::string whole = io::read_text(folder.path() / "a/solve_bar_pull.vtu");
    for (const std::size_t size : {std::size_t{200}, std::size_t{2000}, whole.size() / 2}) {
        io::write_text(folder.path() / "cut.vtu", whole.substr(0, size));
        const auto cut = run_couture(field + "cut.vtu", folder.path());
        CHECK(cut.exit_code == 2);
        CHECK_THAT(cut.errors, Contains("cut.vtu: can't be read as VTK XML"));
        CHECK(std::count(cut.errors.begin(), cut.errors.end(), '\n') == 1);
    }
    io::write_text(folder.path() / "text.vtu", "<html></html>");
    const auto text = run_couture(field + "text.vtu", folder.path());
    CHECK(text.exit_code == 2);
    CHECK_THAT(text.errors, Contains("not a VTK XML file of an unstructured grid"));
}
