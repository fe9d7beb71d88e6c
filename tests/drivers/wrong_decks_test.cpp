// Every way to get a deck wrong, with the whole message.
#include <catch2/catch.hpp>
#include <variant>

#include "drivers/deck_check.h"
#include "drivers/job_geometry.h"
#include "iga/core/error.h"
#include "iga/core/log.h"
#include "io/deck.h"

using namespace couture;

namespace {

/// Line 1 is the title, so that a replaced line keeps its number.
const std::string good_deck = R"(title = "Bracket"
[geometry]
part = "box"
[discretization]
degree = 2
[material.steel]
youngs_modulus = 210e3
poissons_ratio = 0.3
[[fixed]]
on = "x_low"
[[pressure]]
on = "x_high"
value = 1.0
[[output.probe]]
quantity = "volume"
)";

std::string replaced(const std::string& from, const std::string& to) {
    std::string text = good_deck;
    const std::size_t place = text.find(from);
    REQUIRE(place != std::string::npos);
    return text.replace(place, from.size(), to);
}

/// The message of reading a deck and checking it against its geometry.
std::string error_of(const std::string& text, const std::vector<std::string>& overrides = {}) {
    try {
        const io::Deck deck = io::parse_deck(text, "bracket.toml", overrides);
        std::visit(
            [&]<int d>(const iga::MultiPatch<d>& geometry) {
                static_cast<void>(drivers::check_deck<d>(deck, geometry));
                static_cast<void>(drivers::make_space<d>(deck, geometry));
            },
            drivers::load_geometry(deck));
    } catch (const Error& error) {
        return error.what();
    }
    return "no error";
}

}  // namespace

TEST_CASE("deck: a good one passes", "[drivers]") { CHECK(error_of(good_deck) == "no error"); }

TEST_CASE("deck: unknown keys and sections", "[drivers]") {
    CHECK(error_of(replaced("youngs_modulus", "young_modulus")) ==
          "bracket.toml:6: [material.steel] needs 'youngs_modulus' (a pressure > 0)\n"
          "    6 | [material.steel]\n"
          "      | ^~~~~~~~~~~~~~~~\n"
          "bracket.toml:7: unknown key 'young_modulus' in [material.steel]; did you mean "
          "'youngs_modulus'?\n"
          "    7 | young_modulus = 210e3\n"
          "      | ^~~~~~~~~~~~~");
    CHECK(error_of(replaced("[[pressure]]", "[[presure]]")) ==
          "bracket.toml:11: unknown section 'presure' at the top of the deck; did you mean "
          "'pressure'?\n"
          "   11 | [[presure]]\n"
          "      |   ^~~~~~~");
    CHECK(error_of(replaced("degree = 2", "smoothness = 2")) ==
          "bracket.toml:5: unknown key 'smoothness' in [discretization]; there are 'degree', "
          "'elements', 'gauss_points', 'geometry', 'volumetric'\n"
          "    5 | smoothness = 2\n"
          "      | ^~~~~~~~~~");
    CHECK(error_of(replaced("degree = 2", "geometry = \"interpolate\"")) ==
          "bracket.toml:5: unknown geometry 'interpolate'; did you mean 'interpolated'? ('exact', "
          "'interpolated')\n"
          "    5 | geometry = \"interpolate\"\n"
          "      |            ^~~~~~~~~~~~~");
    CHECK(error_of(replaced("[[pressure]]", "[[flux]]")) ==
          "bracket.toml:11: [[flux]] belongs to analysis type 'poisson'; the type of this deck is "
          "'elasticity'\n"
          "   11 | [[flux]]\n"
          "      | ^~~~~~~~");
}

TEST_CASE("deck: wrong kinds of values", "[drivers]") {
    CHECK(error_of(replaced("degree = 2", "degree = 2.5")) ==
          "bracket.toml:5: 'degree' of [discretization] is a number, expected a whole number\n"
          "    5 | degree = 2.5\n"
          "      |          ^~~");
    CHECK(error_of(replaced("on = \"x_low\"", "on = 3")) ==
          "bracket.toml:10: 'on' of [[fixed]] is a whole number, expected a text or a list of "
          "texts\n"
          "   10 | on = 3\n"
          "      |      ^");
    CHECK(error_of(replaced("value = 1.0", "value = [1.0]")) ==
          "bracket.toml:13: 'value' of [[pressure]] is a list, expected a number or a text with a "
          "unit\n"
          "   13 | value = [1.0]\n"
          "      |         ^~~~~");
    CHECK(error_of(replaced("[[pressure]]", "[pressure]")) ==
          "bracket.toml:11: [pressure] may occur several times: write [[pressure]]\n"
          "   11 | [pressure]\n"
          "      | ^~~~~~~~~~");
}

TEST_CASE("deck: values out of range", "[drivers]") {
    CHECK(error_of(replaced("0.3", "0.5")) ==
          "bracket.toml:8: 'poissons_ratio' of [material.steel] = 0.5 is out of range; it must be "
          "in (-1, 0.5)\n"
          "    8 | poissons_ratio = 0.5\n"
          "      |                  ^~~");
    CHECK(error_of(replaced("210e3", "-1")) ==
          "bracket.toml:7: 'youngs_modulus' of [material.steel] = -1 is out of range; it must be > "
          "0\n"
          "    7 | youngs_modulus = -1\n"
          "      |                  ^~");
    CHECK(error_of(replaced("210e3", "nan")) ==
          "bracket.toml:7: 'youngs_modulus' of [material.steel] = nan; it must be finite\n"
          "    7 | youngs_modulus = nan\n"
          "      |                  ^~~");
    CHECK(error_of(replaced("degree = 2", "degree = 9")) ==
          "bracket.toml:5: 'degree' of [discretization] = 9 is out of range; it must be in [1, 8]\n"
          "    5 | degree = 9\n"
          "      |          ^");
    CHECK(error_of(replaced("degree = 2", "elements = 0")) ==
          "bracket.toml:5: 'elements' of [discretization] = 0 is out of range; it must be >= 1\n"
          "    5 | elements = 0\n"
          "      |            ^");
    CHECK(error_of(replaced("degree = 2", "elements = [2, 2]")) ==
          "bracket.toml:4: 'elements' of [discretization] has 2 numbers; the geometry has 3 "
          "directions: give one number or 3");
}

TEST_CASE("deck: units", "[drivers]") {
    CHECK(error_of(replaced("210e3", "'210 mm'")) ==
          "bracket.toml:7: 'youngs_modulus' of [material.steel]: '210 mm' is a length, expected a "
          "pressure\n"
          "    7 | youngs_modulus = '210 mm'\n"
          "      |                  ^~~~~~~~");
    CHECK(error_of(replaced("210e3", "'210 Gpa'")) ==
          "bracket.toml:7: 'youngs_modulus' of [material.steel]: unknown unit 'Gpa'; did you mean "
          "'GPa'?\n"
          "    7 | youngs_modulus = '210 Gpa'\n"
          "      |                  ^~~~~~~~~");
    log::clear_warnings();
    CHECK(error_of(replaced("210e3", "'210 MPa'")) == "no error");
    REQUIRE(log::warnings().size() == 1);
    CHECK(log::warnings()[0] ==
          "bracket.toml:7: youngs_modulus = 210 in units 'mm N MPa' is 0.21 GPa, which is "
          "implausible for 'steel' (expected 150 to 250 GPa); is the unit right?");
    log::clear_warnings();
}

TEST_CASE("deck: expressions", "[drivers]") {
    CHECK(error_of(replaced("1.0", "'2 * x + sin(pi * y)'")) == "no error");
    CHECK(error_of(replaced("1.0", "'2 * sine(x)'")) ==
          "bracket.toml:13: 'value' of [[pressure]]: expression: 'sine' is neither a function nor "
          "one of x, y, z, t, pi, e; did you mean 'sin'?\n"
          "        2 * sine(x)\n"
          "            ^\n"
          "   13 | value = '2 * sine(x)'\n"
          "      |         ^~~~~~~~~~~~~");
    CHECK(error_of(replaced("210e3", "'210e3 * x'")) ==
          "bracket.toml:7: 'youngs_modulus' of [material.steel] must be constant; '210e3 * x' "
          "depends on x\n"
          "    7 | youngs_modulus = '210e3 * x'\n"
          "      |                  ^~~~~~~~~~~");
}

TEST_CASE("deck: what is missing", "[drivers]") {
    CHECK(error_of("") ==
          "bracket.toml: the deck is empty; it needs at least [geometry] and a material");
    CHECK(error_of(replaced("[geometry]\npart = \"box\"\n", "")) ==
          "bracket.toml: the deck needs 'geometry' (the section [geometry] with 'file', 'part' or "
          "'mesh')");
    CHECK(
        error_of(replaced("part = \"box\"", "")) ==
        "bracket.toml:2: [geometry] needs one of 'file' (a spline file), 'part' (a built-in part) "
        "and 'mesh' (a deck for `couture mesh`)\n"
        "    2 | [geometry]\n"
        "      | ^~~~~~~~~~");
    CHECK(error_of(replaced("part = \"box\"", "file = \"none.xml\"")) ==
          "bracket.toml:3: there is no file none.xml (paths are relative to the deck)\n"
          "    3 | file = \"none.xml\"\n"
          "      |        ^~~~~~~~~~");
    CHECK(error_of("[geometry]\npart = \"box\"\n") ==
          "bracket.toml: the deck needs a material: a section [material.NAME] with "
          "'youngs_modulus' and 'poissons_ratio'");
    CHECK(error_of(replaced("on = \"x_high\"", "")) ==
          "bracket.toml:11: [[pressure]] needs 'on' (the name of a boundary set, or a list of "
          "names)\n"
          "   11 | [[pressure]]\n"
          "      | ^~~~~~~~~~~~");
}

TEST_CASE("deck: what the geometry does not have", "[drivers]") {
    CHECK(error_of(replaced("x_high", "x_hihg")) ==
          "bracket.toml:12: unknown set 'x_hihg'; did you mean 'x_high'? There are 'x_high', "
          "'x_low', 'y_high', 'y_low', 'z_high', 'z_low'\n"
          "   12 | on = \"x_hihg\"\n"
          "      |       ^~~~~~");
    CHECK(error_of(replaced("poissons_ratio", "patches = [7]\npoissons_ratio")) ==
          "bracket.toml: [material.steel] names patch 7; the geometry has patches 0 to 0\n"
          "bracket.toml: no material holds for patch 0; add it to the 'patches' of one");
    CHECK(
        error_of(replaced("\"box\"", "\"box\"\nsets = { tip = 'patch 1 side 0:low' }")) ==
        "bracket.toml:2: set 'tip' of [geometry.sets]: 'patch 1 side 0:low': there is no patch 1, "
        "the geometry has patches 0 to 0; write for example 'patch 3 side 0:low' or 'patch 3 "
        "edge 0:low 1:high'");
    CHECK(error_of(replaced("\"box\"", "\"box\"\nsets = { tip = 'patch 0 edge 0:low' }")) ==
          "bracket.toml:2: set 'tip' of [geometry.sets]: 'patch 0 edge 0:low': an edge fixes 2 "
          "directions; write for example 'patch 3 side 0:low' or 'patch 3 edge 0:low 1:high'");
    CHECK(error_of(replaced("[discretization]",
                            "[analysis]\nkinematics = 'plane_strain'\n"
                            "[discretization]")) ==
          "bracket.toml:2: the geometry is a volume: [analysis] must have kinematics = 'solid'\n"
          "    2 | [geometry]\n"
          "      | ^~~~~~~~~~");
}

TEST_CASE("deck: probes", "[drivers]") {
    CHECK(error_of(replaced("\"volume\"", "\"von_mises\"")) ==
          "bracket.toml:15: 'von_mises' needs a place: either 'at', or 'patch' and 'xi'\n"
          "   15 | quantity = \"von_mises\"\n"
          "      |            ^~~~~~~~~~~");
    CHECK(error_of(replaced("\"volume\"", "\"volume\"\nexpect = 0")) ==
          "bracket.toml:16: 'expect' = 0 needs an 'absolute_tolerance' ('tolerance' is relative)\n"
          "   16 | expect = 0\n"
          "      |          ^");
    CHECK(error_of(replaced("\"volume\"", "\"reaction_x\"\non = \"x_high\"")) ==
          "bracket.toml:16: 'reaction_x' needs the set of a support; supported are 'x_low'\n"
          "   16 | on = \"x_high\"\n"
          "      |       ^~~~~~");
}

TEST_CASE("deck: overrides change values and are named in messages", "[drivers]") {
    CHECK(error_of(good_deck, {"pressure.0.value=5", "discretization.elements=[2, 1, 1]"}) ==
          "no error");
    CHECK(error_of(good_deck, {"discretization.degree=x"}) ==
          "--set discretization.degree=x: 'degree' of [discretization] is a text, expected a whole "
          "number");
    CHECK(error_of(good_deck, {"discretization.degre=3"}) ==
          "--set discretization.degre=3: unknown key 'degre' in [discretization]; did you mean "
          "'degree'?");
    const io::Deck deck = io::parse_deck(good_deck, "b.toml", {"title=Other"});
    CHECK(deck.title == "Other");
    CHECK(deck.text == good_deck + "\n# --set title=Other");
}

namespace {

/// A plane body with one more section, which starts in line 9.
std::string plane_deck(const std::string& section) {
    return R"(title = "Plane"
[geometry]
part = "rectangle"
[analysis]
kinematics = "plane_strain"
[material.steel]
youngs_modulus = 210e3
poissons_ratio = 0.3
)" + section;
}

}  // namespace

TEST_CASE("deck: a plane body has no third component", "[drivers]") {
    const std::string rule = "has a z component; a plane body has x and y only, leave it out";
    for (const std::string section :
         {"[[traction]]\non = \"y_high\"\nz = 7\n", "[[body_force]]\nvalue = [0, 0, 7]\n",
          "[[displacement]]\non = \"y_high\"\nz = 7\n",
          "[[point_load]]\nat = [1, 1]\nforce = [0, 0, 5]\n",
          "[[fixed]]\non = \"x_low\"\ndirections = [\"x\", \"z\"]\n",
          "[[foundation]]\non = \"x_low\"\nvalue = [1, 1, 1]\n"}) {
        CAPTURE(section);
        CHECK_THAT(error_of(plane_deck(section)),
                   Catch::Contains("bracket.toml:") && Catch::Contains(rule));
    }
    CHECK(error_of(plane_deck("[[body_force]]\nvalue = [0, 7, 0]\n")) == "no error");
}

TEST_CASE("deck: names that are given twice, can't name a file, or hold nothing", "[drivers]") {
    CHECK(error_of(replaced("on = \"x_high\"", "on = [\"x_high\", \"x_high\"]")) ==
          "bracket.toml:12: 'on' of [[pressure]] names 'x_high' twice; once is enough\n"
          "   12 | on = [\"x_high\", \"x_high\"]\n"
          "      |      ^~~~~~~~~~~~~~~~~~~~");
    CHECK_THAT(error_of(replaced("value = 1.0", "value = 1.0\ncase = \"a/../b\"")),
               Catch::Contains("case 'a/../b' of [[pressure]] can't name a result file"));
    CHECK_THAT(error_of(replaced("[[output.probe]]", "[combination.all]\n[[output.probe]]")),
               Catch::Contains("[combination.all] is empty; give load cases and their factors"));
    CHECK_THAT(error_of(replaced("1.0", "\"2 * t\"")),
               Catch::Contains("bracket.toml:13: 'value' of [[pressure]] depends on the time t, "
                               "which linear analyses do not have"));
    CHECK_THAT(error_of(replaced("1.0", "\"1,5\"")),
               Catch::Contains("bracket.toml:13:") &&
                   Catch::Contains("decimals are written with a point"));
}

TEST_CASE("deck: an axisymmetric body lies right of the axis", "[drivers]") {
    std::string text = plane_deck("[[fixed]]\non = \"x_low\"\n");
    text.replace(text.find("plane_strain"), 12, "axisymmetric");
    CHECK(error_of(text) == "no error");
    const io::Deck deck = io::parse_deck(text, "bracket.toml");
    auto geometry = std::get<iga::MultiPatch<2>>(drivers::load_geometry(deck));
    MatrixX points = geometry.patches[0].control_points();
    points.col(0).array() -= 0.25;
    geometry.patches[0] = iga::Patch<2>(geometry.patches[0].space(), points);
    CHECK_THROWS_WITH(
        drivers::check_deck<2>(deck, geometry),
        Catch::Contains("the geometry reaches x = -0.25; in axisymmetric problems x is "
                        "the radius"));
}

TEST_CASE("deck: patches are named once, strains are not drawn", "[drivers]") {
    CHECK_THAT(error_of(replaced("youngs_modulus", "patches = [0, 0]\nyoungs_modulus")),
               Catch::Contains("'patches' of [material.steel] names patch 0 twice"));
    CHECK_THAT(error_of(replaced("[[output.probe]]",
                                 "[output]\npng_quantity = \"strain_xx\"\n[[output.probe]]")),
               Catch::Contains("bracket.toml:15: unknown png_quantity 'strain_xx'"));
}
