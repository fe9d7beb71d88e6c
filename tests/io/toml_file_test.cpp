#include "io/toml_file.h"

#include <catch2/catch.hpp>

#include "iga/core/error.h"

using namespace couture;
using namespace couture::io;

TEST_CASE("parse_toml: values keep their kind, order and place", "[io]") {
    const TomlNode node = parse_toml("b = 1\na = 2.5\n[s]\n  x = [true, 'text']\n", "d.toml");
    REQUIRE(node.entries.size() == 3);
    CHECK(node.entries[0].first == "b");
    CHECK(node.find("b")->kind == TomlNode::Kind::integer);
    CHECK(node.find("a")->number == 2.5);
    const TomlNode& list = *node.find("s")->find("x");
    CHECK(list.items[0].boolean);
    CHECK(list.items[1].text == "text");
    CHECK(list.place.source == "d.toml:4");
    CHECK(located(list.place, "wrong") ==
          "d.toml:4: wrong\n    4 |   x = [true, 'text']\n      |       ^~~~~~~~~~~~~~");
}

TEST_CASE("parse_toml: what is not TOML is shown with line and caret", "[io]") {
    CHECK_THROWS_WITH(parse_toml("a = 1\nb = \n", "d.toml"),
                      "d.toml:2: not valid TOML: missing value after key-value separator '='\n"
                      "    2 | b = \n      | ^");
    CHECK_THROWS_WITH(parse_toml("a = 1\na = 2\n", "d.toml"),
                      Catch::Contains("d.toml:2: not valid TOML: written twice"));
    CHECK_THROWS_WITH(parse_toml(std::string("\x7f\x45LF\0", 5), "d.toml"),
                      "d.toml: byte 0 = 0x7f is not text; a deck is a TOML text file");
    CHECK_THROWS_WITH(parse_toml("a = " + std::string(5000, '['), "d.toml"),
                      "d.toml: values are nested deeper than 100");
    CHECK_THROWS_WITH(parse_toml("n = 99999999999999999999\n", "d.toml"),
                      Catch::Contains("d.toml:1: whole number with more than 18 digits"));
}

TEST_CASE("override_value: changes, adds and counts entries of lists", "[io]") {
    TomlNode node = parse_toml("[solver]\ntolerance = 1\n[[load]]\nv = 1\n[[load]]\nv = 2\n", "d");
    override_value(node, "solver.tolerance=1e-3");
    override_value(node, "load.1.v='5 MPa'");
    override_value(node, "output.vtu=false");
    override_value(node, "title=two words");
    CHECK(node.find("solver")->find("tolerance")->number == 1e-3);
    CHECK(node.find("load")->items[1].find("v")->text == "5 MPa");
    CHECK_FALSE(node.find("output")->find("vtu")->boolean);
    CHECK(node.find("title")->text == "two words");
    CHECK(node.find("title")->place.source == "--set title=two words");
    CHECK_THROWS_WITH(override_value(node, "solver"), "--set solver: must read section.key=value");
    CHECK_THROWS_WITH(
        override_value(node, "load.2.v=1"),
        "--set load.2.v=1: '2' is not one of the 2 entries of the list; count from 0");
    CHECK_THROWS_WITH(override_value(node, "solver.tolerance.x=1"),
                      "--set solver.tolerance.x=1: 'x' lies below a number, which holds no keys");
}
