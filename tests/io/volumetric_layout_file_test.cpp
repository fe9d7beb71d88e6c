#include "io/volumetric_layout_file.h"

#include <catch2/catch.hpp>

#include "iga/core/error.h"
#include "meshing/layout/layout_validity.h"
#include "tests/data_folder.h"

using namespace couture;

namespace {

// A unit cube and a point that it does not use; `corners` from 1.
std::string medit_cube(const std::string& corners) {
    return "MeshVersionFormatted 2\nDimension 3\nVertices\n9\n0 0 0 0\n5 5 5 0\n1 0 0 0\n1 1 0 0\n"
           "0 1 0 0\n0 0 1 0\n1 0 1 0\n1 1 1 0\n0 1 1 0\nCorners\n1\n1\nHexahedra\n1\n" +
           corners + " 7\nEnd\n";
}

std::string vtk_cube(const std::string& cells) {
    return "# vtk DataFile Version 2.0\na cube\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 8 float\n"
           "0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n" +
           cells;
}

}  // namespace

TEST_CASE("parse_medit_layout: corners lie where the cuboid's directions say", "[io]") {
    for (const char* corners : {"1 3 4 5 6 7 8 9", "6 7 8 9 1 3 4 5"}) {
        const auto placed = io::parse_medit_layout("cube.mesh", medit_cube(corners));
        REQUIRE(placed.layout.n_cuboids() == 1);
        CHECK(placed.layout.n_nodes == 8);
        for (int i = 0; i < 8; ++i) {
            const Vector3 expected(i & 1, i >> 1 & 1, i >> 2 & 1);
            CHECK(placed.positions[placed.layout.cuboids[0][i]] == expected);
        }
    }
}

TEST_CASE("parse_vtk_layout: corners lie where the cuboid's directions say", "[io]") {
    const auto placed = io::parse_vtk_layout(
        "cube.vtk", vtk_cube("CELLS 1 9\n8 0 1 2 3 4 5 6 7\nCELL_TYPES 1\n12\n"));
    CHECK(placed.layout.cuboids[0] == std::array{0, 1, 3, 2, 4, 5, 7, 6});
}

TEST_CASE("volumetric layout files: what is wrong is named with its line or hexahedron", "[io]") {
    const auto medit = [](const std::string& corners) {
        return io::parse_medit_layout("a.mesh", medit_cube(corners));
    };
    CHECK_THROWS_WITH(medit("1 3 4 5 6 7 8 10"),
                      Catch::Contains("a.mesh:19: ") && Catch::Contains("a point of a hexahedron"));
    CHECK_THROWS_WITH(medit("1 3 4 5 6 7 8 8"), "a.mesh: cuboid 0 of the layout has node 6 twice");
    CHECK_THROWS_WITH(medit("1 3 4 5 1 3 4 5"), "a.mesh: hexahedron 0 has no volume");
    CHECK_THROWS_WITH(io::parse_medit_layout("a.mesh", "MeshVersionFormatted 2 Dimension 3 End"),
                      "a.mesh: has no hexahedra");
    CHECK_THROWS_WITH(
        io::parse_medit_layout("a.mesh", "MeshVersionFormatted 2\nDimension 3\nNodes"),
        Catch::Contains("a.mesh:3: found 'Nodes'; expected Vertices"));
    const auto vtk = [](const std::string& cells) {
        return io::parse_vtk_layout("a.vtk", vtk_cube(cells));
    };
    CHECK_THROWS_WITH(vtk("CELLS 1 9\n8 0 1 2 3 4 5 6 7\nCELL_TYPES 1\n10\n"),
                      Catch::Contains("a.vtk:17: ") && Catch::Contains("(12, a hexahedron)"));
    CHECK_THROWS_WITH(vtk("CELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n10\n"),
                      Catch::Contains("a.vtk:14: "));
    CHECK_THROWS_WITH(io::parse_vtk_layout("a.vtk", "solid"),
                      "a.vtk: begins with no '# vtk DataFile Version ...' and title");
    CHECK_THROWS_WITH(io::read_volumetric_layout("a.stl"),
                      Catch::Contains("unknown ending '.stl'"));
    // Two cubes, one in the other's place.
    CHECK_THROWS_WITH(
        vtk("CELLS 2 18\n8 0 1 2 3 4 5 6 7\n8 0 1 2 3 4 5 6 7\nCELL_TYPES 2\n12 12\n"),
        Catch::Contains("a.vtk: cuboids 0 and 1 of the layout share the nodes"));
}

// The hex meshes subdivide the layouts: 8 or 64 elements for each cuboid.
TEST_CASE("read_volumetric_layout: public layouts are volumes of the genus of their meshes",
          "[io]") {
    const auto folder = test::data_folder();
    if (!folder) return;
    struct Expected {
        const char* name;
        int n_cuboids, n_elements_each, genus;
    };
    for (const auto& [name, n_cuboids, n_each, genus] :
         {Expected{"hepta", 118, 8, 0}, Expected{"joint", 96, 64, 1}, Expected{"rod", 20, 64, 2},
          Expected{"mount1", 70, 64, 4}}) {
        INFO(name);
        const auto read = [&](const char* ending) {
            return io::read_volumetric_layout(*folder / "layouts" / (std::string(name) + ending))
                .layout;
        };
        const meshing::VolumetricLayout layout = read("_layout.mesh");
        const meshing::VolumetricLayout mesh = read("_hex.vtk");
        CHECK(layout.n_cuboids() == n_cuboids);
        CHECK(mesh.n_cuboids() == n_cuboids * n_each);
        CHECK(meshing::volume_topology(layout).genera == std::vector{genus});
        CHECK(meshing::volume_topology(mesh).genera == std::vector{genus});
    }
}
