// Every deck of the folder is run as its header comment says.
#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <functional>
#include <sstream>
#include <vector>

#include "io/atomic_file.h"
#include "io/mesh_deck.h"
#include "tests/drivers/run_program.h"

using namespace couture;

namespace fs = std::filesystem;

namespace {

std::vector<fs::path> all_decks() {
    std::vector<fs::path> decks;
    for (const auto& entry :
         fs::directory_iterator(fs::path(COUTURE_SOURCE_DIR) / "drivers/decks")) {
        if (entry.path().extension() == ".toml") {
            decks.push_back(entry.path());
        }
    }
    std::sort(decks.begin(), decks.end());
    return decks;
}

/// "#   $ couture ARGUMENTS" and the lines of comment below it, up to an empty one.
struct SampleRun {
    std::string arguments;
    std::vector<std::string> lines;
};

std::vector<SampleRun> sample_runs(const std::string& deck) {
    const std::string indent = "#   ";
    const std::string prompt = indent + "$ couture ";
    bool is_output = false;
    std::vector<SampleRun> runs;
    std::istringstream stream(deck);
    for (std::string line; std::getline(stream, line) && line.starts_with('#');) {
        if (line.starts_with(prompt)) {
            runs.push_back({line.substr(prompt.size()), {}});
            is_output = true;
        } else if (is_output && line.starts_with(indent)) {
            runs.back().lines.push_back(line.substr(indent.size()));
        } else {
            is_output = false;
        }
    }
    return runs;
}

bool is_of_reduced_model(const fs::path& deck) {
    const std::string name = deck.filename().string();
    return name.starts_with("rom_") || name == "plate_family.toml" || name == "rubber_family.toml";
}

bool is_of_meshing(const fs::path& deck) {
    return !is_of_reduced_model(deck) &&
           (io::is_mesh_deck(deck) || deck.filename() == "half_seal_surface.toml");
}

void check_sample_runs(const std::vector<fs::path>& decks) {
    REQUIRE(decks.size() >= 4);
    for (const fs::path& deck : decks) {
        CAPTURE(deck.filename().string());
        const std::vector<SampleRun> runs = sample_runs(io::read_text(deck));
        REQUIRE_FALSE(runs.empty());
        for (const SampleRun& run : runs) {
            const tests::TemporaryFolder folder;
            fs::create_directory(folder.path() / "drivers");
            fs::create_directory_symlink(deck.parent_path(), folder.path() / "drivers/decks");
            const auto result = tests::run_couture(run.arguments, folder.path());
            CAPTURE(result.output, result.errors);
            CHECK(result.exit_code == 0);
            std::size_t from = 0;
            for (const std::string& line : run.lines) {
                CAPTURE(line);
                const std::size_t place = result.output.find(line + "\n", from);
                CHECK(place != std::string::npos);
                from = place == std::string::npos ? from : place + line.size();
            }
        }
    }
}

std::vector<fs::path> decks_that(const std::function<bool(const fs::path&)>& fit) {
    std::vector<fs::path> decks;
    for (const fs::path& deck : all_decks()) {
        if (fit(deck)) decks.push_back(deck);
    }
    return decks;
}

}  // namespace

// Sample runs give what the headers say, and meet all expectations.

TEST_CASE("decks: sample runs of solves", "[drivers]") {
    check_sample_runs(decks_that(
        [](const fs::path& deck) { return !is_of_meshing(deck) && !is_of_reduced_model(deck); }));
}

TEST_CASE("decks: sample runs of meshes", "[drivers]") {
    check_sample_runs(decks_that(is_of_meshing));
}

TEST_CASE("decks: sample runs of reduced models", "[drivers]") {
    check_sample_runs(decks_that(is_of_reduced_model));
}
