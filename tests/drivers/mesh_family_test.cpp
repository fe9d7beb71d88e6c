#include <fmt/format.h>

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>

#include "io/atomic_file.h"
#include "tests/drivers/run_program.h"

using namespace couture;
using namespace couture::tests;
using Catch::Matchers::Contains;

namespace {

const std::string deck =
    "[geometry]\npart = \"pant\"\n[meshing]\nopen = \"caps\"\nedge_length = 8\nelement_size = 20\n"
    "[family]\nparameters = \"m.csv\"\n";

/// A bar of 20 x 20 x 100, bent about its middle line by an angle in degrees, as OFF.
std::string bent_bar(double degrees) {
    constexpr std::array<int, 3> n{4, 4, 32};
    const double angle = degrees * std::numbers::pi / 180.0;
    std::map<std::array<int, 3>, int> numbers;
    std::string points;
    std::string triangles;
    const auto vertex = [&](const std::array<int, 3>& at) {
        const auto [entry, is_new] = numbers.try_emplace(at, static_cast<int>(numbers.size()));
        if (is_new) {
            const double x = 20.0 * at[0] / n[0] - 10.0;
            const double z = 100.0 * at[2] / n[2];
            const double radius = angle == 0.0 ? 0.0 : 100.0 / angle;
            const double turn = angle * z / 100.0;
            points += fmt::format(
                "{:.9g} {:.9g} {:.9g}\n", angle == 0.0 ? x : (radius + x) * std::cos(turn) - radius,
                20.0 * at[1] / n[1], angle == 0.0 ? z : (radius + x) * std::sin(turn));
        }
        return entry->second;
    };
    int n_triangles = 0;
    for (int k = 0; k < 3; ++k) {
        const int a = (k + 1) % 3;
        const int b = (k + 2) % 3;
        for (int cell = 0; cell < 2 * n[a] * n[b]; ++cell) {
            const bool is_high = cell >= n[a] * n[b];
            std::array<int, 3> at{};
            at[k] = is_high ? n[k] : 0;
            at[a] = cell % n[a];
            at[b] = cell / n[a] % n[b];
            std::array<int, 4> quad{};
            for (int c = 0; c < 4; ++c) {
                std::array<int, 3> corner = at;
                corner[is_high ? a : b] += c == 1 || c == 2 ? 1 : 0;
                corner[is_high ? b : a] += c >= 2 ? 1 : 0;
                quad[c] = vertex(corner);
            }
            triangles += fmt::format("3 {} {} {}\n3 {} {} {}\n", quad[0], quad[1], quad[2], quad[0],
                                     quad[2], quad[3]);
            n_triangles += 2;
        }
    }
    return fmt::format("OFF\n{} {} 0\n{}{}", numbers.size(), n_triangles, points, triangles);
}

std::vector<std::string> files_in(const std::filesystem::path& folder) {
    std::vector<std::string> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        files.push_back(entry.path().filename().string());
    }
    std::sort(files.begin(), files.end());
    return files;
}

}  // namespace

TEST_CASE("mesh family: members are done, those that fail are reported", "[drivers]") {
    const TemporaryFolder folder;
    io::write_text(folder.path() / "f.toml", deck);
    io::write_text(folder.path() / "m.csv", "name,X1,Z2\na,20,0\nwrong,400,0\nb,-20,15\n");
    const auto result = run_couture("mesh f.toml --png --json --out o", folder.path());
    CHECK(result.exit_code == 1);
    const auto object = nlohmann::json::parse(result.output);
    CHECK(object["status"] == "failed");
    CHECK(object["failed_members"] == 1);
    CHECK(object["failed_midpoints"] == 0);
    CHECK(object["reference"] == "reference");
    const auto& members = object["members"];
    REQUIRE(members.size() == 4);
    for (const int m : {0, 1, 3}) {
        CAPTURE(m);
        CHECK(members[m]["status"] == "done");
        CHECK(members[m]["signature"] == object["signature"]);
        CHECK(members[m]["certificate"] == "valid");
        CHECK(members[m]["homology"]["homologous"] == true);
        CHECK(members[m]["homology"]["points_per_curve"] == 200);
    }
    CHECK(members[3]["midpoint_with_reference"] == "valid");
    CHECK(members[3]["midpoint_with_previous"] == "valid");
    CHECK(members[2]["status"] == "failed");
    CHECK_THAT(members[2]["reason"].get<std::string>(), Contains("X1 = 400"));
    CHECK(files_in(folder.path() / "o") ==
          std::vector<std::string>{"a_volume.xml", "b_volume.xml", "f_family.png", "f_members.json",
                                   "reference_layout.json", "reference_volume.xml"});
    CHECK(object["files"].size() == 6);
    // The same layout by the record of the reference alone.
    const auto again = run_couture(
        "mesh pant --set X1=20 --edge-length 8 --stage volume --like o/reference_layout.json "
        "--json --out again",
        folder.path());
    REQUIRE(again.exit_code == 0);
    CHECK(nlohmann::json::parse(again.output)["volume"]["signature"] == object["signature"]);
    CHECK(io::read_text(folder.path() / "again/pant_volume.xml") ==
          io::read_text(folder.path() / "o/a_volume.xml"));
}

TEST_CASE("mesh family: bodies with one hole are cut as the reference was", "[drivers]") {
    const TemporaryFolder folder;
    io::write_text(folder.path() / "m.csv", "name,P1,P2\nwide,48,75\nnarrow,22,125\n");
    io::write_text(folder.path() / "f.toml",
                   "[geometry]\npart = \"plate\"\n[meshing]\nelement_size = 30\n[family]\n"
                   "parameters = \"m.csv\"\n");
    const auto result = run_couture("mesh f.toml", folder.path());
    CAPTURE(result.errors);
    CHECK(result.exit_code == 0);
    CHECK_THAT(result.output, Contains("3 of 3 members done, midpoints of 0 not certified"));
}

TEST_CASE("mesh family: files are matched by where they lie", "[drivers]") {
    const TemporaryFolder folder;
    REQUIRE(run_couture("convert cube a.off", folder.path()).exit_code == 0);
    REQUIRE(run_couture("convert cube --set length=120 --edge-length 15 b.off", folder.path())
                .exit_code == 0);
    io::write_text(folder.path() / "m.csv", "\xEF\xBB\xBFsurface\nb.off\n");
    io::write_text(folder.path() / "f.toml",
                   "[geometry]\nsurface = \"a.off\"\n[meshing]\nelement_size = 50\n[family]\n"
                   "parameters = \"m.csv\"\n");
    const auto result = run_couture("mesh f.toml", folder.path());
    CHECK(result.exit_code == 0);
    CHECK_THAT(result.output, Contains("2 of 2 members done, midpoints of 0 not certified"));
    CHECK_THAT(io::read_text(folder.path() / "out/f/b_volume.xml"), Contains("face_6"));
}

TEST_CASE("mesh family: of a member with other features a picture is left", "[drivers]") {
    const TemporaryFolder folder;
    REQUIRE(run_couture("convert cube a.off", folder.path()).exit_code == 0);
    REQUIRE(run_couture("convert cylinder other.off", folder.path()).exit_code == 0);
    REQUIRE(run_couture("convert cube --set length=120 b.off", folder.path()).exit_code == 0);
    io::write_text(folder.path() / "m.csv", "name,surface\nother,other.off\nb,b.off\n");
    io::write_text(folder.path() / "f.toml",
                   "[geometry]\nsurface = \"a.off\"\n[meshing]\nelement_size = 50\n[family]\n"
                   "parameters = \"m.csv\"\n");
    const auto result = run_couture("mesh f.toml --json --out o", folder.path());
    CHECK(result.exit_code == 1);
    auto object = nlohmann::json::parse(result.output);
    CHECK(object["failed_members"] == 1);
    CHECK(object["members"][1]["name"] == "other");
    CHECK(object["members"][1]["status"] == "failed");
    CHECK_THAT(object["members"][1]["reason"].get<std::string>(),
               Contains("is closed and has no corner"));
    CHECK(object["members"][2]["status"] == "done");
    CHECK(std::filesystem::file_size(folder.path() / "o/other_failed_features.png") > 1000);
    CHECK_FALSE(std::filesystem::exists(folder.path() / "o/other_volume.xml"));
    // What failed is tried again, the others are not.
    const auto resumed = run_couture("mesh f.toml --out o --resume", folder.path());
    CHECK(resumed.exit_code == 1);
    CHECK_THAT(resumed.errors, Contains("reference is done already") && Contains("other failed") &&
                                   Contains("b is done already"));
}

TEST_CASE("mesh family: members that fold are reported with a picture, the others are done",
          "[drivers]") {
    const TemporaryFolder folder;
    const auto picture = [&](const char* name) {
        return std::filesystem::file_size(folder.path() / "o" / name);
    };
    // The third folds between its elements, the fourth runs through itself.
    for (const auto& [name, degrees] : {std::pair("straight", 0.0), std::pair("quarter", 90.0),
                                        std::pair("hook", 345.0), std::pair("coil", 400.0)}) {
        io::write_text(folder.path() / (std::string(name) + ".off"), bent_bar(degrees));
    }
    io::write_text(folder.path() / "m.csv", "surface\nhook.off\ncoil.off\nquarter.off\n");
    io::write_text(folder.path() / "f.toml",
                   "[geometry]\nsurface = \"straight.off\"\n[meshing]\nelement_size = 50\n"
                   "[family]\nparameters = \"m.csv\"\n");
    const auto result = run_couture("mesh f.toml --json --out o", folder.path());
    CAPTURE(result.errors);
    CHECK(result.exit_code == 1);
    const auto object = nlohmann::json::parse(result.output);
    CHECK(object["failed_members"] == 2);
    const auto& members = object["members"];
    CHECK(members[1]["certificate"] == "folded");
    CHECK_THAT(members[1]["reason"].get<std::string>(),
               Contains("its volume is folded in patch 0, where det J has"));
    CHECK_THAT(members[2]["reason"].get<std::string>(),
               Contains("coil.off can't be meshed") && Contains("self-intersection"));
    CHECK(members[3]["status"] == "done");
    CHECK(members[3]["midpoint_with_reference"] == "valid");
    CHECK(files_in(folder.path() / "o") ==
          std::vector<std::string>{"coil_failed_surface.png", "coil_problems.vtp", "f_members.json",
                                   "hook_failed_volume.png", "quarter_volume.xml",
                                   "reference_layout.json", "reference_volume.xml"});
    CHECK(object["files"].size() == 7);
    CHECK(picture("hook_failed_volume.png") > 1000);
    CHECK(picture("coil_failed_surface.png") > 1000);

    // Mended, and one that was done folds now: nothing of the earlier runs is left of either.
    io::write_text(folder.path() / "hook.off", bent_bar(60.0));
    io::write_text(folder.path() / "coil.off", bent_bar(-60.0));
    io::write_text(folder.path() / "quarter.off", bent_bar(345.0));
    const auto again = run_couture("mesh f.toml --out o", folder.path());
    CHECK(again.exit_code == 1);
    CHECK_THAT(again.output, Contains("3 of 4 members done"));
    CHECK(files_in(folder.path() / "o") ==
          std::vector<std::string>{"coil_volume.xml", "f_members.json", "hook_volume.xml",
                                   "quarter_failed_volume.png", "reference_layout.json",
                                   "reference_volume.xml"});
}

TEST_CASE("mesh family: an interrupted run leaves whole files and is resumed", "[drivers]") {
    const TemporaryFolder folder;
    const auto file = [&](const char* name) { return folder.path() / "o" / name; };
    io::write_text(folder.path() / "f.toml", deck);
    io::write_text(folder.path() / "m.csv", "name,X1\na,20\nb,-20\nc,10\nd,-10\n");
    // As soon as a member is there.
    const auto stopped = run_couture(
        "mesh f.toml --out o & pid=$!; while kill -0 $pid && [ ! -e o/a_volume.xml ]; do "
        "sleep 0.05; done; kill -INT $pid; wait $pid",
        folder.path());
    CHECK(stopped.exit_code == 130);
    for (const auto& entry : std::filesystem::directory_iterator(folder.path() / "o")) {
        CAPTURE(entry.path().string());
        const bool is_whole = entry.path().extension() == ".json" ||
                              Contains("</xml>").match(io::read_text(entry.path()));
        CHECK(is_whole);
    }
    CHECK_FALSE(std::filesystem::exists(file("d_volume.xml")));
    const auto time = std::filesystem::last_write_time(file("reference_volume.xml"));

    const auto resumed = run_couture("mesh f.toml --out o --resume --json", folder.path());
    REQUIRE(resumed.exit_code == 0);
    CHECK(std::filesystem::last_write_time(file("reference_volume.xml")) == time);
    CHECK_THAT(resumed.errors, Contains("reference is done already"));
    auto object = nlohmann::json::parse(resumed.output);
    auto whole =
        nlohmann::json::parse(run_couture("mesh f.toml --out whole --json", folder.path()).output);
    for (auto* run : {&object, &whole}) {
        for (auto& member : (*run)["members"]) member.erase("seconds");
    }
    CHECK(object["members"] == whole["members"]);
    CHECK(io::read_text(file("d_volume.xml")) ==
          io::read_text(folder.path() / "whole/d_volume.xml"));

    // A member whose file was cut since is meshed again.
    const std::string volume = io::read_text(file("b_volume.xml"));
    io::write_text(file("b_volume.xml"), volume.substr(0, volume.size() / 2));
    const auto mended = run_couture("mesh f.toml --out o --resume", folder.path());
    CHECK(mended.exit_code == 0);
    CHECK_THAT(mended.errors, Contains("b is meshed again") && Contains("c is done already"));
    CHECK(io::read_text(file("b_volume.xml")) == volume);

    const auto other =
        run_couture("mesh f.toml --out o --resume --set meshing.element_size=30", folder.path());
    CHECK(other.exit_code == 2);
    CHECK_THAT(other.errors, Contains("f_members.json was written by another deck"));
    CHECK_THAT(run_couture("mesh cube --resume", folder.path()).errors,
               Contains("--resume goes on with the members of a family"));
}
