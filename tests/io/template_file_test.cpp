#include "io/template_file.h"

#include <catch2/catch.hpp>
#include <fstream>

#include "iga/core/error.h"
#include "meshing/layout/layout_validity.h"
#include "tests/io/temporary_folder.h"

using namespace couture;
using namespace couture::meshing;

namespace {

void parse(const std::string& text, TemplateLibrary& library) {
    io::parse_templates(text, "my.toml", library);
}

std::string complaint(const std::string& text) {
    TemplateLibrary library;
    try {
        parse(text, library);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

}  // namespace

TEST_CASE("built_in_templates: all are valid, sorted, for zero to six caps", "[io]") {
    const TemplateLibrary library = io::built_in_templates();
    for (int n_caps = 0; n_caps <= 6; ++n_caps) {
        INFO(n_caps);
        CHECK_FALSE(library.with_caps(n_caps).empty());
        int n_cuboids = 0;
        for (const CuboidTemplate& shape : library.with_caps(n_caps)) {
            INFO(shape.name);
            CHECK(shape.layout.n_cuboids() >= n_cuboids);
            n_cuboids = shape.layout.n_cuboids();
            // All are balls.
            constexpr int chi = 2;
            const QuadLayout closed = layout_boundary(shape.layout).layout;
            CHECK(judge_layout(closed, chi).is_cuboid_configuration);
            CHECK(judge_layout(wall_of(shape).layout, chi - n_caps).is_cuboid_configuration);
            CHECK(volume_topology(shape.layout).chi == chi / 2);
        }
    }
    // [Maquart19] Fig. 6.4.
    CHECK(library.find("tee").layout.n_nodes == 20);
    CHECK(library.find("tee_2").layout.n_nodes == 28);
    CHECK(library.find("tee_3").layout.n_nodes == 36);
    CHECK(library.find("plus").layout.n_cuboids() == 5);
    CHECK(library.find("suit").layout.n_cuboids() == 6);
    CHECK(library.find("spacesuit").layout.n_cuboids() == 7);
}

TEST_CASE("add_templates: a user's file adds to the library", "[io]") {
    const io::TemporaryFolder folder;
    const auto path = folder / "my.toml";
    std::ofstream(path) << "[[template]]\nname = 'my_bar'\ngenerator = 'bar'\n"
                           "section = [[0, 0], [0, 1]]\n\n"
                           "[[template]]\nname = 'brick'\ncuboids = [[0, 1, 2, 3, 4, 5, 6, 7]]\n"
                           "positions = [[0, 0, 0], [2, 0, 0], [0, 1, 0], [2.5, 1, 0], [0, 0, 1], "
                           "[2, 0, 1], [0, 1, 1], [2.5, 1, 1]]\n"
                           "caps = [{ name = 'end', sides = [[0, 1]] }]\n";
    TemplateLibrary library = io::built_in_templates();
    const std::size_t n_before = library.templates().size();
    io::add_templates(path, library);
    CHECK(library.templates().size() == n_before + 2);
    CHECK(library.find("my_bar").n_caps() == 2);
    const CuboidTemplate& brick = library.find("brick");
    CHECK(brick.caps == std::vector<std::string>{"end"});
    CHECK(brick.positions[3] == Vector3(2.5, 1.0, 0.0));
    CHECK_THROWS_AS(io::add_templates(folder / "none.toml", library), FileError);
}

TEST_CASE("parse_templates: what is wrong is named with its line, entry and rule", "[io]") {
    const std::string start = "[[template]]\nname = 'mine'\n";
    CHECK_THAT(complaint("[[template]]\ngenerator = 'star'"),
               Catch::StartsWith("my.toml:1: [[template]] needs 'name'"));
    CHECK_THAT(complaint(start + "generator = 'starr'\nlegs = 4"),
               Catch::StartsWith("my.toml:3: there is no generator 'starr'; did you mean 'star'?"));
    CHECK_THAT(complaint(start + "generator = 'star'\nlegs = 9"),
               Catch::StartsWith("my.toml:1: template 'mine': a star has 3 to 6 legs, not 9"));
    CHECK_THAT(complaint(start + "generator = 'star'\nlegs = 4\nleg = 1"),
               Catch::StartsWith("my.toml:5: template 'mine': unknown key 'leg'; did you mean "
                                 "'legs'?"));
    CHECK_THAT(complaint(start + "generator = 'bar'"),
               Catch::StartsWith("my.toml:1: template 'mine' needs 'section'"));
    CHECK_THAT(complaint(start + "generator = 'bar'\nsection = [[0, 0, 0]]"),
               Catch::StartsWith("my.toml:4: found 3 numbers, expected 2"));
    CHECK_THAT(complaint(start + "generator = 'bar'\nsection = [[0, 0.5]]"),
               Catch::StartsWith("my.toml:4: found a number, expected a whole number"));
    CHECK_THAT(complaint(start + "generator = 'polycube'\ncells = [[0, 0, 0]]\n"
                                 "caps = [{ name = 'a', sides = [[0, 6]] }]"),
               Catch::StartsWith("my.toml:5: side 6; sides are 0 to 5"));
    CHECK_THAT(complaint(start + "generator = 'polycube'\ncells = [[0, 0, 0]]\n"
                                 "caps = [{ name = 'a', side = [[0, 5]] }]"),
               Catch::StartsWith("my.toml:5: a cap is { name"));
    CHECK_THAT(complaint(start + "generator = 'polycube'\ncells = [[0, 0, 0]]\n"
                                 "caps = [{ name = 'a', sides = [[1, 5]] }]"),
               Catch::Contains("cap 'a' has side 5 of cuboid 1, which is no outer side"));
    CHECK_THAT(complaint(start + "cuboids = [[0, 1, 2, 3, 4, 5, 6, 7]]\npositions = [[0, 0]]"),
               Catch::StartsWith("my.toml:4: found something else, expected a position"));
    CHECK_THAT(complaint("[template]\nname = 'mine'"),
               Catch::Contains("a file of templates has [[template]] only"));
    // All at once; the good one is kept.
    TemplateLibrary library;
    CHECK_THROWS_WITH(parse(start + "generator = 'star'\nlegs = 4\n" + start +
                                "generator = 'star'\nlegs = 5\n[[template]]\nname = 3",
                            library),
                      Catch::Contains("my.toml:5: template 'mine' is there already") &&
                          Catch::Contains("my.toml:10: 'name' is a whole number"));
    CHECK(library.templates().size() == 1);
}
