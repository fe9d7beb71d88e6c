#include "io/rom_section.h"

#include <catch2/catch.hpp>

#include "iga/core/error.h"
#include "io/deck.h"

using namespace couture;
using Catch::Matchers::Contains;

namespace {

const std::string model = R"([geometry]
part = "plate_with_hole_3d"
[material.steel]
youngs_modulus = "210 GPa"
poissons_ratio = 0.3
[[fixed]]
on = "x_high"
[[resultant]]
on = "y_high"
force = [0, 10, 0]
)";

io::Deck parse(const std::string& rom) { return io::parse_deck(model + rom, "family.toml"); }

std::string error_of(const std::string& rom) {
    try {
        static_cast<void>(parse(rom));
    } catch (const InputError& error) {
        return error.what();
    }
    return {};
}

const std::string radius = R"([[rom.parameter]]
key = "geometry.parameters.hole_radius"
range = [0.5, 2]
)";

}  // namespace

TEST_CASE("rom section: parameters, their groups and their design", "[io]") {
    const io::Deck deck = parse(R"([rom]
design = "lhs"
samples = 12
seed = 7
basis = "stacked"
modes = 9
inner_product = "euclidean"
correlation = "gaussian"
trend = "linear"
)" + radius + R"([[rom.parameter]]
name = "load"
key = "resultant.0.force.1"
range = [5, 15]
unit = "N"
levels = 3
[[rom.parameter]]
name = "E"
key = "material.steel.youngs_modulus"
range = [200, 220]
unit = "GPa"
factored = true
)");
    REQUIRE(deck.rom);
    const io::RomSection& rom = *deck.rom;
    CHECK(rom.design == io::GeometryDesign::lhs);
    CHECK(rom.n_samples == 12);
    CHECK(rom.seed == 7);
    CHECK(rom.is_stacked);
    CHECK(rom.n_modes == 9);
    CHECK_FALSE(rom.is_l2);
    CHECK(rom.correlation == rom::CorrelationKind::gaussian);
    CHECK(rom.trend == rom::Trend::linear);
    REQUIRE(rom.parameters.size() == 3);
    CHECK(rom.parameters[0].parameter.name == "hole_radius");
    CHECK(rom.inputs(rom::ParameterGroup::geometry) == std::vector<int>{0});
    CHECK(rom.inputs(rom::ParameterGroup::load) == std::vector<int>{1});
    CHECK(rom.inputs(rom::ParameterGroup::material).empty());
    CHECK(rom.parameters[1].n_levels == 3);
    CHECK(rom.parameters[2].is_factored);
}

TEST_CASE("rom section: a point becomes values of the deck with their units", "[io]") {
    const std::string text = "[rom]\n" + radius + R"([[rom.parameter]]
name = "E"
key = "material.steel.youngs_modulus"
range = [200, 220]
unit = "GPa"
)";
    const io::Deck deck = parse(text);
    const VectorX point = Eigen::Vector2d(1.0 / 3.0, 205.5);
    const io::Deck there = io::parse_deck(model + text, "family.toml", deck.rom->overrides(point));
    CHECK(there.geometry.parameters.at("hole_radius") == 1.0 / 3.0);
    // N / mm^2
    CHECK(there.problem.materials[0].stiffness(3, 3) == Approx(205.5e3 / 2.6).epsilon(1e-14));
}

TEST_CASE("rom section: mistakes are named with their place", "[io]") {
    CHECK_THAT(error_of("[rom]\n"), Contains("needs at least one [[rom.parameter]]"));
    CHECK_THAT(error_of("[rom]\ndesign = \"lhs\"\n" + radius), Contains("needs 'samples'"));
    CHECK_THAT(error_of("[rom]\ndesign = \"lhs\"\nsamples = 3\nlevel = 2\n" + radius),
               Contains("has no 'level'"));
    CHECK_THAT(error_of("[rom]\nlevel = 3\n" + radius), Contains("level"));
    CHECK_THAT(error_of("[rom]\n" + radius + radius), Contains("two parameters are called"));
    const auto one = [](const std::string& lines) {
        return error_of("[rom]\n[[rom.parameter]]\n" + lines);
    };
    CHECK_THAT(one("range = [0, 1]\n"), Contains("needs 'key'"));
    CHECK_THAT(one("key = \"resultant.0.force.1\"\n"), Contains("needs 'range'"));
    CHECK_THAT(one("key = \"resultant.0.force.1\"\nrange = [2, 1]\n"), Contains("is empty"));
    CHECK_THAT(one("key = \"resultant.1.force.1\"\nrange = [1, 2]\n"),
               Contains("names nothing in this deck"));
    CHECK_THAT(one("key = \"resultant.0.force\"\nrange = [1, 2]\n"),
               Contains("name one of its entries"));
    CHECK_THAT(one("key = \"solver.tolerance\"\nrange = [1, 2]\n"),
               Contains("is neither below geometry.parameters nor"));
    CHECK_THAT(one("key = [\"geometry.parameters.a\", \"resultant.0.force.1\"]\nrange = [1, 2]\n"),
               Contains("belong to different groups"));
    CHECK_THAT(one("key = \"geometry.parameters.hole_radius\"\nrange = [1, 2]\nfactored = true\n"),
               Contains("no displacement is proportional"));
    CHECK_THAT(one("key = \"resultant.0.force.1\"\nrange = [-1, 1]\nfactored = true\n"),
               Contains("must not hold 0"));
    CHECK_THAT(one("key = \"resultant.0.force.1\"\nrange = [1, 2]\nunit = \"Nm2x\"\n"),
               Contains("unit"));
    CHECK_THAT(one("key = \"resultant.0.force.1\"\nrange = [1, 2]\nlevels = 1\n"),
               Contains("it must be in [2, 1000]"));
    CHECK_THAT(error_of("[rom]\n" + radius +
                        "[[rom.parameter]]\nname = \"again\"\nkey = "
                        "\"geometry.parameters.hole_radius\"\nrange = [1, 2]\n"),
               Contains("have the same key 'geometry.parameters.hole_radius'"));
    CHECK_THAT(one("key = \"resultant.0.force.1\"\nrange = [1, 2]\ncolour = 1\n"),
               Contains("unknown key 'colour'"));
}
