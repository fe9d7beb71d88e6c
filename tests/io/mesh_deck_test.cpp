#include "io/mesh_deck.h"

#include <catch2/catch.hpp>
#include <numbers>

#include "iga/core/error.h"
#include "io/atomic_file.h"
#include "tests/io/temporary_folder.h"

using namespace couture;
using Catch::Matchers::Contains;

namespace {

io::MeshDeck parse(const std::string& text) { return io::parse_mesh_deck(text, "job.toml"); }

const std::string wheel = "[geometry]\npart = \"wheel\"\n";

}  // namespace

TEST_CASE("mesh deck: all keys are read, lengths in the deck's units", "[io]") {
    const io::MeshDeck deck = parse(R"(
title = "A wheel"
[units]
system = "m N Pa"
[geometry]
part = "wheel"
[geometry.parameters]
R1 = "9 mm"
[meshing]
stage = "loops"
edge_length = "5 mm"
feature_angle = 30
corner_angle = 60
open = ["caps", "rim"]
open_at = [[1, 2, 3]]
open_facing = [[0, 0, 1], [1, 0, 0]]
cycle = { symmetry = 2.0, sharp = 0.5 }
merge = { length = 1 }
most_boundaries = 5
merge_ratio = 2.5
loop_width = 0.1
[[meshing.loop]]
points = [[0, 0, 0], [1, 0, 0], [0, "1 mm", 0]]
[[meshing.cycle_through]]
points = [[4, 5, 6]]
corners = ["a", "b"]
)");
    CHECK(deck.title == "A wheel");
    CHECK(deck.parameters.at("R1") == Approx(0.009));
    CHECK(deck.stage == "loops");
    CHECK(deck.edge_length == Approx(0.005));
    CHECK(deck.features.angle == Approx(std::numbers::pi / 6.0));
    CHECK(deck.features.corner_angle == Approx(std::numbers::pi / 3.0));
    CHECK(deck.open.all);
    CHECK(deck.open.names == std::vector<std::string>{"rim"});
    CHECK(deck.open.points.at(0) == Vector3(1, 2, 3));
    CHECK(deck.open.normals.size() == 2);
    CHECK(deck.pants.cycle.length == 0.0);
    CHECK(deck.pants.cycle.symmetry == 2.0);
    CHECK(deck.pants.cycle.sharp == 0.5);
    CHECK(deck.pants.merge.length == 1.0);
    CHECK(deck.pants.most_boundaries == 5);
    CHECK(deck.pants.merge_ratio == 2.5);
    CHECK(deck.pants.loop_width == 0.1);
    CHECK(deck.pants.loops.at(0).points.at(2) == Vector3(0, 0.001, 0));
    CHECK(deck.cycles_through.at(0).points.size() == 1);
    CHECK(deck.cycles_through.at(0).corners == std::vector<std::string>{"a", "b"});
}

TEST_CASE("mesh deck: angles are in degrees, or have their unit", "[io]") {
    const io::MeshDeck deck =
        parse(wheel + "[meshing]\nfeature_angle = \"100 deg\"\ncorner_angle = \"0.5 rad\"\n");
    CHECK(deck.features.angle == Approx(std::numbers::pi * 100.0 / 180.0));
    CHECK(deck.features.corner_angle == Approx(0.5));
    CHECK(parse(wheel + "[meshing]\nfeature_angle = \"40 + 60\"\n").features.angle ==
          Approx(deck.features.angle));
}

TEST_CASE("mesh deck: how the surface is mapped", "[io]") {
    const auto solid = [](const std::string& keys) {
        return parse(wheel + "[meshing]\n" + keys).solid;
    };
    using meshing::LayoutMapRoute;
    CHECK(solid("").route == LayoutMapRoute::aligned);
    CHECK(solid("parameterization = \"harmonic\"\n").route == LayoutMapRoute::harmonic);
    CHECK(solid("parameterization = \"quadratic\"\n").route == LayoutMapRoute::quadratic);
    CHECK(solid("alignment = 2\nrelocations = 25\n").alignment == 2.0);
    CHECK(solid("alignment = 2\nrelocations = 25\n").max_relocations == 25);
    CHECK_THROWS_WITH(solid("parameterization = \"quadratic\"\nalignment = 2\n"),
                      Contains("no place beside parameterization = \"quadratic\""));
    CHECK_THROWS_WITH(solid("relocations = -1\n"), Contains("relocations"));
}

TEST_CASE("mesh deck: what is left out has its default", "[io]") {
    const io::MeshDeck deck = parse(wheel);
    CHECK(deck.stage == "pants");
    CHECK(deck.edge_length == 0.0);
    CHECK(deck.open.is_empty());
    CHECK(deck.pants.cycle.length == 1.0);
    CHECK(deck.pants.most_boundaries == 3);
    CHECK(deck.like.empty());
}

TEST_CASE("mesh deck: mistakes name the line and the rule", "[io]") {
    const auto refused = [](const std::string& text, const std::string& message) {
        CAPTURE(text);
        CHECK_THROWS_WITH(parse(text), Contains(message));
    };
    refused("title = \"x\"\n", "the section [geometry] with 'surface' or 'part'");
    refused("[geometry]\n", "either 'surface'");
    refused("[geometry]\nsurface = \"no.stl\"\n", "job.toml:2: there is no file no.stl");
    refused("[geometry]\npart = \"wheel\"\nsurface = \"no.stl\"\n", "either 'surface'");
    refused(wheel + "[meshing]\nstage = \"pant\"\n", "job.toml:4");
    refused(wheel + "[meshing]\nstages = 1\n", "did you mean 'stage'");
    refused(wheel + "[meshing]\nedge_length = -1\n", "edge_length");
    refused(wheel + "[meshing]\nfeature_angle = 180\n", "feature_angle");
    refused(wheel + "[meshing]\nfeature_angle = \"190 deg\"\n", "job.toml:4");
    refused(wheel + "[meshing]\ncorner_angle = \"3.2 rad\"\n", "corner_angle");
    refused(wheel + "[meshing]\ncorner_angle = \"3 mm\"\n", "corner_angle");
    refused(wheel + "[meshing]\nopen_at = [1, 2, 3]\n", "expected points [x, y, z]");
    refused(wheel + "[meshing]\nopen_at = [[1, 2]]\n", "open_at");
    refused(wheel + "[meshing]\nopen_at = 3\n", "expected a list of points");
    refused(wheel + "[meshing]\ncycle = { length = 1, sharp = -1 }\n", "must be positive");
    refused(wheel + "[meshing]\ncycle = { sharp = 1 }\n", "one must be positive");
    refused(wheel + "[meshing]\ncycle = { weight = 1 }\n", "weight");
    refused(wheel + "[meshing]\ncycle = 1\n", "expected weights");
    refused(wheel + "[meshing]\nmost_boundaries = 7\n", "most_boundaries");
    refused(wheel + "[meshing]\n[[meshing.loop]]\npoints = [[0,0,0]]\n", "at least 3 'points'");
    refused(wheel + "[meshing]\n[[meshing.cycle_through]]\n", "needs 'points' or 'corners'");
    refused(wheel + "[material.steel]\nyoungs_modulus = 1\n", "material");
    refused(wheel + "[meshing]\nlike = \"no.json\"\n", "there is no file no.json");
    const io::TemporaryFolder folder;
    io::write_text(folder / "part.off", "OFF\n");
    io::write_text(folder / "other.json", "{}\n");
    const auto in_folder = [&](const std::string& text) {
        return io::parse_mesh_deck(text, folder / "job.toml");
    };
    const std::string file = "[geometry]\nsurface = \"part.off\"\n";
    CHECK(in_folder(file).surface == folder / "part.off");
    CHECK_THROWS_WITH(in_folder(file + "[meshing]\nedge_length = 1\n"),
                      Contains("'edge_length' is for parts"));
    CHECK_THROWS_WITH(in_folder(file + "[geometry.parameters]\nR = 1\n"),
                      Contains("belongs to 'part'"));
    CHECK_THROWS_WITH(in_folder(file + "[[meshing.cycle_through]]\ncorners = [\"a\"]\n"),
                      Contains("'corners' are names of a part's"));
    CHECK_THROWS_WITH(in_folder(wheel + "[meshing]\nlike = \"other.json\"\n"
                                        "[[meshing.cycle_through]]\npoints = [[0,0,0]]\n"),
                      Contains("have no place beside it"));
    io::write_text(folder / "mesh.toml", wheel + "[meshing]\n");
    io::write_text(folder / "solve.toml", wheel);
    io::write_text(folder / "surface.toml", file);
    CHECK(io::is_mesh_deck(folder / "mesh.toml"));
    CHECK(io::is_mesh_deck(folder / "surface.toml"));
    CHECK_FALSE(io::is_mesh_deck(folder / "solve.toml"));
}

TEST_CASE("mesh deck: a layout of one's own and a family are refused together", "[io]") {
    const io::TemporaryFolder folder;
    io::write_text(folder / "l.toml", "");
    const std::string text =
        "[geometry]\npart = \"cube\"\n[meshing]\nlayout = \"l.toml\"\n[family]\ndesign = "
        "\"star\"\n";
    CHECK_THROWS_WITH(static_cast<void>(io::parse_mesh_deck(text, folder / "f.toml")),
                      Contains("a 'layout' of one's own in [meshing] has neither"));
}
