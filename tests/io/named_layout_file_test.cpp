#include "io/named_layout_file.h"

#include <catch2/catch.hpp>

#include "iga/core/error.h"

using namespace couture;
using Catch::Matchers::Contains;

namespace {

const std::string nodes =
    "[nodes]\na = [0, 0, 0]\nb = [2, 0, 0]\nc = [0, 1, 0]\nd = [2, 1, 0]\n"
    "e = [0, 0, 1]\nf = [2, 0, 1]\ng = [0, 1, 1]\nh = \"top\"\n";
const std::string cuboid =
    "[[cuboid]]\nnodes = [\"a\", \"b\", \"c\", \"d\", \"e\", \"f\", \"g\", \"h\"]\n";

io::NamedLayout parse(const std::string& text) {
    return io::parse_named_layout("my.toml", text, {{"top", Vector3(2, 1, 1)}},
                                  io::UnitSystem("m N Pa"));
}

}  // namespace

TEST_CASE("named layout: nodes at points and corners, lengths in the deck's units", "[io]") {
    const io::NamedLayout layout = parse("tolerance = \"5 mm\"\n" + nodes + cuboid);
    CHECK(layout.tolerance == Approx(0.005));
    CHECK(layout.placed.layout.node_names.back() == "h");
    CHECK(layout.placed.positions.at(7) == Vector3(2, 1, 1));
    CHECK(layout.placed.layout.cuboids.at(0) == std::array{0, 1, 2, 3, 4, 5, 6, 7});
    // A mirrored one is turned.
    const io::NamedLayout mirrored = parse(
        nodes + "[[cuboid]]\nnodes = [\"e\", \"f\", \"g\", \"h\", \"a\", \"b\", \"c\", \"d\"]\n");
    CHECK(mirrored.placed.layout.cuboids == layout.placed.layout.cuboids);
    CHECK_FALSE(mirrored.tolerance);
}

TEST_CASE("named layout: mistakes name the line, the node and the rule", "[io]") {
    const auto refused = [](const std::string& text, const std::string& message) {
        CAPTURE(text);
        CHECK_THROWS_WITH(parse(text), Contains(message));
    };
    refused(cuboid, "the section [nodes]");
    refused("nodes = 3\n" + cuboid, "expected the section [nodes]");
    refused(nodes, "[[cuboid]] with 'nodes'");
    refused("tolerance = 0\n" + nodes + cuboid, "my.toml:1");
    refused(nodes + "i = [0, 0]\n" + cuboid, "my.toml:10");
    refused(nodes + "i = \"topp\"\n" + cuboid,
            "node 'i' lies at the corner 'topp', which the part does not have; did you mean 'top'");
    refused(nodes + "i = [5, 5, 5]\n" + cuboid, "my.toml:10: node 'i' belongs to no cuboid");
    refused(nodes + "[[cuboid]]\nnodes = [\"a\", \"b\"]\n", "a cuboid has 8 nodes, here are 2");
    refused(
        nodes + "[[cuboid]]\nnodes = [\"a\", \"b\", \"c\", \"d\", \"e\", \"f\", \"g\", \"x\"]\n",
        "there is no node 'x' in [nodes]");
    refused(
        nodes + "[[cuboid]]\nnodes = [\"a\", \"b\", \"c\", \"d\", \"e\", \"f\", \"g\", \"a\"]\n",
        "node 'a' stands twice in the cuboid");
    refused(nodes + cuboid + cuboid, "my.toml: ");
    refused(nodes + cuboid + "[[arc]]\n", "arc");
    CHECK_THROWS_WITH(io::parse_named_layout("my.toml", nodes + cuboid),
                      Contains("corners of a file have no names"));
}
