#include <catch2/catch.hpp>
#include <random>

#include "iga/core/error.h"
#include "io/atomic_file.h"
#include "io/spline_file.h"
#include "tests/io/sample_splines.h"

using namespace couture;
using Catch::Matchers::Contains;

namespace {

/// True if the file is read or refused by an error of ours; anything else escapes.
bool is_handled(const std::filesystem::path& path) {
    try {
        static_cast<void>(io::read_splines(path));
    } catch (const Error& error) {
        return std::string(error.what()).size() > 0;
    }
    return true;
}

void replace(std::string& text, const std::string& from, const std::string& to) {
    const std::size_t place = text.find(from);
    REQUIRE(place != std::string::npos);
    text.replace(place, from.size(), to);
}

/// The message of reading `extension` file with one passage replaced.
std::string message(const std::string& extension, const std::string& from, const std::string& to) {
    const test::TemporaryFolder folder;
    const std::filesystem::path path = folder / ("pair" + extension);
    iga::MultiPatch<3> multipatch = test::make_pair<3>(3, 0, true);
    multipatch.boundary_sets.erase("clamped");
    io::write_splines(path, multipatch);
    std::string text = io::read_text(path);
    replace(text, from, to);
    io::write_text(path, text);
    try {
        static_cast<void>(io::read_splines(path));
    } catch (const FileError& error) {
        return error.what();
    }
    return "no error";
}

}  // namespace

TEST_CASE("read_splines: truncated and mutated files are read or refused, never worse", "[io]") {
    const std::string extension = GENERATE(".xml", ".mesh", ".txt", ".inp", ".NB", ".h5");
    constexpr int n_trials = 60;
    const test::TemporaryFolder folder;
    const std::filesystem::path path =
        folder / ("pair" + (extension == ".NB" ? std::string(".inp") : extension));
    const std::filesystem::path changed = folder / ("pair" + extension);
    iga::MultiPatch<3> multipatch = test::make_pair<3>(3, 2, true);
    if (extension == ".mesh") {
        multipatch.boundary_sets.erase("clamped");
    }
    io::write_splines(path, multipatch);
    const std::string whole = io::read_text(changed);
    std::mt19937 random(7);
    constexpr char characters[] =
        "0-9.eE \n\t<>/\"*,#()\0\xff"
        "nainf";
    const std::string junk(characters, sizeof(characters) - 1);
    for (int i = 0; i < n_trials; ++i) {
        std::string text = whole;
        if (i % 3 == 0) {
            text.resize(whole.size() * static_cast<std::size_t>(i) / n_trials);
        }
        for (int k = 0; k < i % 5 && !text.empty(); ++k) {
            const std::size_t place = random() % text.size();
            if (random() % 4 == 0) {
                text.insert(place, std::to_string(random()) + std::to_string(random()));
            } else {
                text[place] = junk[random() % junk.size()];
            }
        }
        io::write_text(changed, text);
        INFO(extension << " trial " << i);
        CHECK(is_handled(path));
    }
}

TEST_CASE("read_splines: empty, binary, missing and foreign files are named", "[io]") {
    const test::TemporaryFolder folder;
    for (const std::string extension : {".xml", ".mesh", ".txt", ".inp", ".h5"}) {
        const std::filesystem::path path = folder / ("a" + extension);
        CHECK_THROWS_WITH(io::read_splines(path), Contains(path.string()));
        io::write_text(path, "");
        CHECK_THROWS_WITH(io::read_splines(path),
                          Contains(path.string()) && Contains("the file is empty"));
        io::write_text(path, std::string("\x01\x02\x00\xff\xfe garbage \x00", 16));
        io::write_text(folder / "a.NB", "*Dimension\n3\n");
        CHECK_THROWS_AS(io::read_splines(path), FileError);
    }
    io::write_text(folder / "tets.mesh", "MeshVersionFormatted 2\nDimension 3\n");
    CHECK_THROWS_WITH(io::read_splines(folder / "tets.mesh"), Contains("Medit"));
}

TEST_CASE("read_splines: a missing .NB is named", "[io]") {
    const test::TemporaryFolder folder;
    io::write_splines(folder / "a.inp", test::make_pair<3>(0, 0, false));
    std::filesystem::remove(folder / "a.NB");
    CHECK_THROWS_WITH(io::read_splines(folder / "a.inp"), Contains("a.NB"));
}

TEST_CASE("read_splines: wrong numbers are named with their line", "[io]") {
    CHECK_THAT(message(".xml", "degree=\"2\"", "degree=\"99\""),
               Contains("pair.xml:") && Contains("found '99'") && Contains("from 1 to 8"));
    CHECK_THAT(message(".xml", "geoDim=\"3\"", "geoDim=\"2\""), Contains("pair.xml:"));
    CHECK_THAT(message(".xml", "0 2 1 1", "0 2 1 9"), Contains("a side, a whole number"));
    CHECK_THAT(message(".mesh", "0 0 0 0.333", "0 0 0 nan0.333"), Contains("expected a number"));
    CHECK_THAT(message(".mesh", "2 4 0 0", "2 1000000000000 0 0"),
               Contains("pair.mesh:") && Contains("expected a number of control points"));
    CHECK_THAT(message(".mesh", "2 4 0 0", "2 90000000 0 0"), Contains("the file holds at most"));
    CHECK_THAT(message(".txt", "4 3 4", "4 300000 400000"), Contains("more than 100000000"));
    CHECK_THAT(message(".txt", "v.2.1", "v.9"), Contains("expected v.2.1"));
    CHECK_THAT(message(".inp", "*Node,nset=AllNode\n1,", "*Node,nset=AllNode\n99,"),
               Contains("has node 1;"));
    CHECK_THAT(message(".h5", "Couture splines 1\n", "Couture splines 1\n9"),
               Contains("the file was cut or changed"));
}

TEST_CASE("read_splines: an interface that contradicts the shape names both sides and the gap",
          "[io]") {
    CHECK_THAT(message(".xml", "<interfaces>0 2 1 1", "<interfaces>0 2 1 2"),
               Contains("patch 0 side 0:high") && Contains("patch 1 side 0:high"));
}
