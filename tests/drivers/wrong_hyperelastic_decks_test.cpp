// Every way to get a hyperelastic deck wrong.
#include <catch2/catch.hpp>

#include "iga/core/error.h"
#include "iga/core/log.h"
#include "io/deck.h"

using namespace couture;
using Catch::Matchers::Contains;

namespace {

const std::string good_deck = R"(title = "Rubber"
[geometry]
part = "box"
[discretization]
volumetric = "full"
[material.rubber]
model = "neo_hookean"
shear_modulus = 3.0
bulk_modulus = 20.0
[[fixed]]
on = "x_low"
[[pressure]]
on = "x_high"
value = 1.0
amplitude = "ramp"
[amplitude.ramp]
t = [0, 0.3, 1]
value = [0, 2, 1]
[stepping]
end = 2.0
first_step = 0.1
smallest_step = 0.01
largest_step = 0.5
[remeshing]
at = [0.5, 1.5]
[output]
every = 2
[[output.probe]]
quantity = "volume"
t = 0.7
)";

std::string replaced(const std::string& from, const std::string& to) {
    std::string text = good_deck;
    const std::size_t place = text.find(from);
    REQUIRE(place != std::string::npos);
    return text.replace(place, from.size(), to);
}

std::string error_of(const std::string& text) {
    try {
        static_cast<void>(io::parse_deck(text, "rubber.toml"));
    } catch (const Error& error) {
        return error.what();
    }
    return "no error";
}

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

}  // namespace

TEST_CASE("hyperelastic deck: a good one is read", "[drivers]") {
    const io::Deck deck = io::parse_deck(good_deck, "rubber.toml");
    CHECK(deck.is_hyperelastic());
    CHECK(deck.stepping.end == 2.0);
    CHECK(deck.stepping.first_step == 0.1);
    CHECK(deck.stepping.volumetric == iga::Volumetric::full);
    CHECK(deck.stepping.stops == std::vector<double>{0.3, 0.5, 0.7, 1.0, 1.5});
    REQUIRE(deck.problem.pressures.at(0).amplitude);
    CHECK((*deck.problem.pressures[0].amplitude)(0.15) == 1.0);
    CHECK(deck.problem.pressures[0].follows_body);
    CHECK(deck.output.every == 2);
    CHECK(deck.output.png_scale == 1.0);
}

TEST_CASE("hyperelastic deck: materials", "[drivers]") {
    CHECK(error_of(replaced("shear_modulus = 3.0", "shear_modulus = -3.0")) ==
          "rubber.toml:8: 'shear_modulus' of [material.rubber] = -3 is out of range; it must be > "
          "0\n"
          "    8 | shear_modulus = -3.0\n"
          "      |                 ^~~~");
    CHECK_THAT(error_of(replaced("bulk_modulus = 20.0", "bulk_modulus = 0")),
               Contains("'bulk_modulus' of [material.rubber] = 0 is out of range; it must be > 0"));
    CHECK_THAT(error_of(replaced("bulk_modulus", "poissons_ratio")),
               Contains("needs either 'shear_modulus' and 'bulk_modulus', or 'youngs_modulus' and "
                        "'poissons_ratio'"));
    CHECK_THAT(error_of(replaced("bulk_modulus = 20.0", "")),
               Contains("[material.rubber] needs 'bulk_modulus' (a pressure > 0)"));
    CHECK_THAT(error_of(replaced("shear_modulus = 3.0\nbulk_modulus = 20.0",
                                 "youngs_modulus = 3.0\npoissons_ratio = 0.5")),
               Contains("'poissons_ratio' of [material.rubber] = 0.5 is out of range; it must be "
                        "in (-1, 0.5)"));
    CHECK_THAT(error_of(replaced("neo_hookean", "neo_hooke")),
               Contains("unknown model 'neo_hooke'; did you mean 'neo_hookean'?"));
    CHECK_THAT(
        error_of(replaced("bulk_modulus = 20.0", "bulk_modulus = 20.0\nthermal_expansion = 1e-5")),
        Contains("rubber.toml:10: [material.rubber]: hyperelastic materials have no thermal "
                 "strain"));
    CHECK(first_line(error_of(
              good_deck + "[material.steel]\nyoungs_modulus = 210e3\npoissons_ratio = 0.3\n")) ==
          "rubber.toml:31: [material.steel] is linear, [material.rubber] hyperelastic; give all "
          "materials of a deck a hyperelastic 'model', or none");
}

TEST_CASE("hyperelastic deck: Young's modulus and Poisson's ratio are converted", "[drivers]") {
    const io::Deck deck = io::parse_deck(
        replaced("shear_modulus = 3.0\nbulk_modulus = 20.0",
                 "youngs_modulus = 8.571428571428571\npoissons_ratio = 0.428571428571428571"),
        "rubber.toml");
    CHECK(deck.problem.materials[0].hyperelastic->shear_modulus == Approx(3.0).epsilon(1e-12));
    CHECK(deck.problem.materials[0].hyperelastic->bulk_modulus == Approx(20.0).epsilon(1e-12));
}

TEST_CASE("hyperelastic deck: what only linear ones have", "[drivers]") {
    CHECK(error_of(replaced("value = 1.0", "value = 1.0\ncase = \"pull\"")) ==
          "rubber.toml:15: 'case' of [[pressure]]: hyperelastic bodies are loaded along one path "
          "in time, without load cases; give the load an 'amplitude'\n"
          "   15 | case = \"pull\"\n"
          "      |        ^~~~~~");
    CHECK_THAT(error_of(good_deck + "[combination.all]\npull = 1.0\n"),
               Contains("[combination.NAME] adds load cases, which hyperelastic bodies do not "
                        "have"));
    CHECK_THAT(error_of(good_deck + "[[temperature]]\nchange = 1.0\n"),
               Contains("[[temperature]]: hyperelastic materials have no thermal strain"));
    CHECK_THAT(error_of(replaced("at = [0.5, 1.5]", "at = [0.5]\nmesher = \"surfaces\"")),
               Contains("mesher") && Contains("'surface'"));
    CHECK_THAT(error_of(good_deck + "[analysis]\nkinematics = \"plane_stress\"\n"),
               Contains("rubber.toml:32: kinematics 'plane_stress' is for linear materials only"));
}

TEST_CASE("linear deck: what only hyperelastic ones have", "[drivers]") {
    const std::string linear =
        replaced("model = \"neo_hookean\"\nshear_modulus = 3.0\nbulk_modulus = 20.0",
                 "youngs_modulus = 3.0\npoissons_ratio = 0.3");
    const std::string error = error_of(linear);
    CHECK_THAT(error, Contains("[stepping] belongs to hyperelastic materials; those of this deck "
                               "are linear"));
    CHECK_THAT(error, Contains("[remeshing] belongs to hyperelastic materials"));
    CHECK_THAT(error, Contains("'volumetric' of [discretization] belongs to hyperelastic"));
    CHECK_THAT(error, Contains("[amplitude.NAME] is a table over time"));
    CHECK_THAT(error, Contains("'every' of [output] counts the steps of hyperelastic runs"));
    CHECK_THAT(error, Contains("'t' of [[output.probe]] is a time of a hyperelastic run"));
    const std::string plain = R"([geometry]
part = "box"
[material.steel]
youngs_modulus = 3.0
poissons_ratio = 0.3
[[fixed]]
on = "x_low"
[[pressure]]
on = "x_high"
)";
    CHECK_THAT(error_of(plain + "value = \"t\"\n"), Contains("depends on the time t"));
    CHECK_THAT(error_of(plain + "value = 1.0\nfollows_body = false\n"),
               Contains("'follows_body' of [[pressure]] needs hyperelastic materials"));
}

TEST_CASE("hyperelastic deck: steps", "[drivers]") {
    CHECK(error_of(replaced("smallest_step = 0.01", "smallest_step = 0.2")) ==
          "rubber.toml:22: 'smallest_step' of [stepping] = 0.2 is larger than 'first_step' = 0.1; "
          "smallest_step <= first_step <= largest_step <= end\n"
          "   22 | smallest_step = 0.2\n"
          "      |                 ^~~");
    CHECK_THAT(error_of(replaced("first_step = 0.1", "first_step = 0.6")),
               Contains("rubber.toml:21: 'first_step' of [stepping] = 0.6 is larger than "
                        "'largest_step' = 0.5"));
    CHECK_THAT(error_of(replaced("largest_step = 0.5", "largest_step = 3")),
               Contains("rubber.toml:23: 'largest_step' of [stepping] = 3 is larger than 'end' = "
                        "2"));
    CHECK_THAT(error_of(replaced("end = 2.0", "end = 2.0\ncontrol = \"arc_length\"")),
               Contains("rubber.toml:21: control = 'arc_length' of [stepping] needs 'max_steps'"));
    CHECK_THAT(error_of(replaced("end = 2.0", "end = 0")),
               Contains("'end' of [stepping] = 0 is out of range; it must be > 0"));
    CHECK_THAT(error_of(replaced("end = 2.0", "end = 2.0\ntolerance = 1")),
               Contains("'tolerance' of [stepping] = 1 is out of range; it must be in (0, 1)"));
    CHECK_THAT(error_of(replaced("end = 2.0", "ende = 2.0")),
               Contains("unknown key 'ende' in [stepping]; did you mean 'end'?"));
}

TEST_CASE("hyperelastic deck: sizes that are not given fit those that are", "[drivers]") {
    const auto stepping_of = [](const std::string& keys) {
        return io::parse_deck(
                   "[geometry]\npart = \"box\"\n[material.a]\nmodel = \"neo_hookean\"\n"
                   "shear_modulus = 1.0\nbulk_modulus = 1.0\n[stepping]\n" +
                       keys,
                   "rubber.toml")
            .stepping;
    };
    CHECK(stepping_of("end = 10").first_step == 1.0);
    CHECK(stepping_of("end = 10").largest_step == 2.5);
    CHECK(stepping_of("first_step = 0.5").largest_step == 0.5);
    CHECK(stepping_of("largest_step = 0.01").first_step == 0.01);
    CHECK(stepping_of("first_step = 1e-6").smallest_step == 1e-6);
    CHECK(stepping_of("smallest_step = 0.2").first_step == 0.2);
}

TEST_CASE("hyperelastic deck: tables over time", "[drivers]") {
    CHECK(error_of(replaced("amplitude = \"ramp\"", "amplitude = \"rmp\"")) ==
          "rubber.toml:15: unknown amplitude 'rmp'; did you mean 'ramp'?\n"
          "   15 | amplitude = \"rmp\"\n"
          "      |             ^~~~~");
    CHECK_THAT(error_of(replaced("[0, 0.3, 1]", "[0, 1, 0.3]")),
               Contains("'t' of [amplitude.ramp]: 0.3 follows 1; times must increase"));
    CHECK_THAT(error_of(replaced("[0, 2, 1]", "[0, 2]")),
               Contains("[amplitude.ramp]: 't' has 3 numbers, 'value' has 2; each time needs one "
                        "value"));
    CHECK_THAT(error_of(replaced("[0, 2, 1]", "[]")),
               Contains("'value' of [amplitude.ramp] is a list, expected a list of numbers"));
    CHECK_THAT(error_of(replaced("t = [0, 0.3, 1]\n", "")),
               Contains("[amplitude.ramp] needs 't' (a list of increasing times)"));
    CHECK_THAT(error_of(replaced("[[fixed]]", "[[foundation]]\nnormal = \"1+t\"")),
               Contains("[[foundation]] depends on the time t; springs do not change"));
}

TEST_CASE("hyperelastic deck: remeshing and probes", "[drivers]") {
    CHECK_THAT(error_of(replaced("at = [0.5, 1.5]", "")), Contains("[remeshing] says never; give"));
    CHECK_THAT(error_of(replaced("at = [0.5, 1.5]", "at = [0.5, 2.5]")),
               Contains("'at' of [remeshing] holds 2.5, not before the end of the run, 2"));
    CHECK_THAT(error_of(replaced("at = [0.5, 1.5]", "scaled_jacobian = 1.5")),
               Contains("'scaled_jacobian' of [remeshing] = 1.5 is out of range; it must be in (0, "
                        "1)"));
    CHECK_THAT(error_of(good_deck + "[analysis]\nkinematics = \"plane_strain\"\n"),
               Contains("[remeshing] is for volumes; plane bodies can't be meshed again"));
    const std::string arc =
        error_of(replaced("end = 2.0", "end = 2.0\ncontrol = \"arc_length\"\nmax_steps = 9"));
    CHECK_THAT(arc, Contains("'at' of [remeshing]: steps of control = 'arc_length' end at no"));
    CHECK_THAT(arc, Contains("'t' of [[output.probe]]: steps of control = 'arc_length' end at no"));
    CHECK_THAT(error_of(replaced("t = 0.7", "t = 2.7")),
               Contains("'t' of [[output.probe]] = 2.7 is after the end of the run, 2"));
}

TEST_CASE("hyperelastic deck: implausible materials and tables in vain are warned of",
          "[drivers]") {
    const auto warnings_of = [](const std::string& text) {
        log::clear_warnings();
        static_cast<void>(io::parse_deck(text, "rubber.toml"));
        const std::vector<std::string> warnings = log::warnings();
        log::clear_warnings();
        return warnings;
    };
    CHECK(warnings_of(good_deck).empty());
    CHECK_THAT(warnings_of(replaced("shear_modulus = 3.0\nbulk_modulus = 20.0",
                                    "shear_modulus = 3e5\nbulk_modulus = 2e6"))
                   .at(0),
               Contains("which is implausible for 'rubber'"));
    CHECK_THAT(warnings_of(replaced("bulk_modulus = 20.0", "bulk_modulus = 2e4")).at(0),
               Contains("'rubber' is nearly incompressible (Poisson's ratio 0.499925) and "
                        "volumetric = 'full' locks; take 'automatic' or 'projected'"));
    CHECK(warnings_of(replaced("bulk_modulus = 20.0", "bulk_modulus = 2e4")
                          .replace(good_deck.find("\"full\""), 6, "\"projected\""))
              .empty());
    CHECK(warnings_of(replaced("amplitude = \"ramp\"", "")).at(0) ==
          "[amplitude.ramp] is used by no load");
}

TEST_CASE("hyperelastic deck: what the states depend on", "[drivers]") {
    const auto model_of = [](const std::string& text) {
        return io::parse_deck(text, "rubber.toml").model_text;
    };
    const std::string model = model_of(good_deck);
    CHECK(model_of(replaced("title = \"Rubber\"", "title = \"Gum\"")) == model);
    CHECK(model_of(replaced("first_step = 0.1", "first_step = 0.2")) == model);
    CHECK(model_of(replaced("at = [0.5, 1.5]", "on_failure = true")) == model);
    CHECK(model_of(replaced("every = 2", "every = 1")) == model);
    // Nothing grows until the end here.
    CHECK(model_of(replaced("end = 2.0", "end = 3.0")) == model);
    CHECK(model_of(replaced("value = 1.0", "value = 2.0")) != model);
    CHECK(model_of(replaced("[0, 2, 1]", "[0, 3, 1]")) != model);
    CHECK(model_of(replaced("amplitude = \"ramp\"", "")) !=
          model_of(replaced("amplitude = \"ramp\"", "")
                       .replace(replaced("amplitude = \"ramp\"", "").find("end = 2.0"), 9,
                                "end = 3.0")));
}
