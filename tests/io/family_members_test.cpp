#include "io/family_members.h"

#include <catch2/catch.hpp>

#include "iga/core/error.h"
#include "io/atomic_file.h"
#include "tests/io/temporary_folder.h"

using namespace couture;
using Catch::Matchers::Contains;

namespace {

std::vector<io::FamilyMember> members_of(const io::TemporaryFolder& folder,
                                         const std::string& family,
                                         const std::string& geometry = "part = \"seal\"") {
    return io::family_members(io::parse_mesh_deck(
        "[geometry]\n" + geometry + "\n[family]\n" + family, folder / "deck.toml"));
}

std::vector<std::string> names_of(const std::vector<io::FamilyMember>& members) {
    std::vector<std::string> names;
    for (const auto& member : members) names.push_back(member.name);
    return names;
}

}  // namespace

TEST_CASE("family members: a table with names, the reference first", "[io]") {
    const io::TemporaryFolder folder;
    io::write_text(folder / "m.csv", "name, R1, R3\nsmall, 11, 35\n\nlarge, 15, 45.5\n");
    const auto members = members_of(folder, "parameters = \"m.csv\"",
                                    "part = \"seal\"\n[geometry.parameters]\nR1 = 12\nL1 = 70");
    CHECK(names_of(members) == std::vector<std::string>{"reference", "small", "large"});
    CHECK(members[0].parameters == std::map<std::string, double>{{"R1", 12.0}, {"L1", 70.0}});
    CHECK(members[2].parameters ==
          std::map<std::string, double>{{"R1", 15.0}, {"R3", 45.5}, {"L1", 70.0}});
    const auto named = members_of(folder, "parameters = \"m.csv\"\nreference = \"large\"");
    CHECK(names_of(named) == std::vector<std::string>{"large", "small"});
    io::write_text(folder / "m.csv", "R1\n11\n12\n");
    CHECK(names_of(members_of(folder, "parameters = \"m.csv\"\nreference = \"member_2\"")) ==
          std::vector<std::string>{"member_2", "member_1"});
}

TEST_CASE("family members: files", "[io]") {
    const io::TemporaryFolder folder;
    for (const char* file : {"a.stl", "b.stl"}) io::write_text(folder / file, "");
    io::write_text(folder / "m.csv", "name,surface\nb,b.stl\n");
    const auto members = members_of(folder, "parameters = \"m.csv\"", "surface = \"a.stl\"");
    REQUIRE(members.size() == 2);
    CHECK(members[0].surface.filename() == "a.stl");
    CHECK(members[1].surface.filename() == "b.stl");
    CHECK_THROWS_WITH(members_of(folder, "parameters = \"m.csv\""),
                      Contains("'b' is a 'surface', but the deck's geometry is a part"));
}

TEST_CASE("family members: the star of a part's parameters", "[io]") {
    const io::TemporaryFolder folder;
    const auto star = members_of(folder, "design = \"star\"");
    REQUIRE(star.size() == 13);
    CHECK(star[1].name == "R1_low");
    CHECK(star[1].parameters == std::map<std::string, double>{{"R1", 11.0}});
    CHECK(star[2].parameters == std::map<std::string, double>{{"R1", 15.0}});
    const auto level_2 = members_of(folder, "design = \"star\"\nlevel = 2", "part = \"pant\"");
    CHECK(level_2.size() == 37);
    const auto some = members_of(folder, "design = \"star\"\nmembers = [\"H1_low\", \"R2_high\"]");
    REQUIRE(some.size() == 3);
    CHECK(some[0].name == "reference");
    CHECK(some[1].name == "R2_high");
    CHECK(some[2].name == "H1_low");
    // In metres.
    const auto in_metres = io::family_members(io::parse_mesh_deck(
        "[units]\nsystem = \"m N Pa\"\n[geometry]\npart = \"seal\"\n[family]\ndesign = \"star\"\n"
        "level = 2",
        folder / "deck.toml"));
    REQUIRE(in_metres[2].name == "R1_low_half");
    CHECK(in_metres[2].parameters.at("R1") == Approx(0.012));
    CHECK_THROWS_WITH(members_of(folder, "design = \"star\"", "part = \"sael\""),
                      Contains("'sael' is none"));
}

TEST_CASE("family members: mistakes are named with their line", "[io]") {
    const io::TemporaryFolder folder;
    const auto refused = [&](const std::string& text, const std::string& message,
                             const std::string& more = "") {
        io::write_text(folder / "m.csv", text);
        CAPTURE(text);
        CHECK_THROWS_WITH(members_of(folder, "parameters = \"m.csv\"\n" + more), Contains(message));
    };
    refused("", "m.csv: no members");
    refused("R1,R3\n1\n", "m.csv:2: 1 cells, but 2 columns");
    refused("R1\n1x\n", "m.csv:2: '1x' in column 'R1' is no number");
    refused("R1\nnan\n", "is no number");
    refused("R1,R1\n1,2\n", "m.csv:1: column 'R1' is there twice");
    refused("name,R1\na,1\na,2\n", "m.csv:3: there is a member 'a' already");
    refused("name\n../a\n", "m.csv:2: '../a' is no name of a member");
    refused("name,surface\na,none.stl\n", "m.csv:2: there is no file");
    refused("name,R1\nsmall,1\n", "did you mean 'small'", "reference = \"smal\"");
    CHECK_THROWS_WITH(members_of(folder, "design = \"star\"\nmembers = \"R1_lo\""),
                      Contains("[family] members 'R1_lo' is none of the members; did you mean"));
    CHECK_THROWS_WITH(members_of(folder, "level = 2"), Contains("needs either 'parameters'"));
    CHECK_THROWS_WITH(members_of(folder, "parameters = \"m.csv\"\nlevel = 2"),
                      Contains("'level' belongs to 'design'"));
    CHECK_THROWS_WITH(members_of(folder, "design = \"star\"\nreference = \"a\""),
                      Contains("own geometry is the reference"));
    CHECK_THROWS_WITH(
        members_of(folder, "design = \"star\"", "part = \"seal\"\n[meshing]\nstage = \"quads\""),
        Contains("[family] makes volumes"));
}
