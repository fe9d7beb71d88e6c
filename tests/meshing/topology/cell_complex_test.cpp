#include "meshing/topology/cell_complex.h"

#include <catch2/catch.hpp>
#include <functional>

#include "iga/core/error.h"

using namespace couture;
using namespace couture::meshing;

namespace {

using Hexahedra = std::vector<std::array<int, 8>>;

// Unit cubes of a box of nx x ny x nz for which `is_full(x, y, z)`.
Hexahedra make_voxels(int nx, int ny, int nz, const std::function<bool(int, int, int)>& is_full) {
    Hexahedra cells;
    for (int z = 0; z < nz; ++z) {
        for (int y = 0; y < ny; ++y) {
            for (int x = 0; x < nx; ++x) {
                if (!is_full(x, y, z)) continue;
                auto& cell = cells.emplace_back();
                for (int i = 0; i < 8; ++i) {
                    cell[i] = (x + (i & 1)) +
                              (nx + 1) * ((y + (i >> 1 & 1)) + (ny + 1) * (z + (i >> 2 & 1)));
                }
            }
        }
    }
    return cells;
}

// The eight cubes on the boundary of the tesseract; vertex = its four coordinates as bits.
Hexahedra make_tesseract_boundary() {
    Hexahedra cells;
    for (int axis = 0; axis < 4; ++axis) {
        for (const int side : {0, 1}) {
            auto& cell = cells.emplace_back();
            for (int i = 0; i < 8; ++i) {
                const int low = i & ((1 << axis) - 1);
                cell[i] = low | side << axis | (i >> axis) << (axis + 1);
            }
        }
    }
    return cells;
}

}  // namespace

TEST_CASE("CellComplex: volumes have the Betti numbers of their tunnels and cavities",
          "[meshing][topology]") {
    struct Row {
        std::string name;
        Hexahedra cells;
        std::vector<int> betti;
        std::vector<int> boundary_betti;
    };
    const auto ring = [](int x, int y) {
        return x >= 1 && x <= 3 && y >= 1 && y <= 3 && !(x == 2 && y == 2);
    };
    const std::vector<Row> rows{
        {"ball", make_voxels(3, 3, 3, [](int, int, int) { return true; }), {1, 0, 0, 0}, {1, 0, 1}},
        {"solid torus, Fig. 6.1 (D)",
         make_voxels(3, 3, 1, [](int x, int y, int) { return x != 1 || y != 1; }),
         {1, 1, 0, 0},
         {1, 2, 1}},
        {"hollow ball, Fig. 6.1 (A)",
         make_voxels(3, 3, 3, [](int x, int y, int z) { return x != 1 || y != 1 || z != 1; }),
         {1, 0, 1, 0},
         {2, 0, 2}},
        {"three tunnels",
         make_voxels(7, 3, 1, [](int x, int y, int) { return x % 2 == 0 || y != 1; }),
         {1, 3, 0, 0},
         {1, 6, 1}},
        {"two balls",
         make_voxels(3, 1, 1, [](int x, int, int) { return x != 1; }),
         {2, 0, 0, 0},
         {2, 0, 2}},
        // Two through holes, a cavity that is a ring, one that is a cube.
        {"Fig. 6.2",
         make_voxels(11, 5, 3,
                     [&](int x, int y, int z) {
                         if ((x == 5 || x == 7) && y == 2) return false;
                         if (x == 9 && y == 2 && z == 1) return false;
                         return z != 1 || !ring(x, y);
                     }),
         {1, 3, 2, 0},
         {3, 6, 3}},
    };
    for (const Row& row : rows) {
        CAPTURE(row.name);
        const CellComplex complex = make_hexahedron_complex(row.cells);
        REQUIRE(betti_numbers(complex) == row.betti);
        REQUIRE(betti_numbers(complex, 2) == row.betti);
        REQUIRE(complex.euler_characteristic() == row.betti[0] - row.betti[1] + row.betti[2]);
        REQUIRE_NOTHROW(check_volume_boundary(complex));
        const CellComplex boundary = boundary_complex(complex);
        REQUIRE(betti_numbers(boundary) == row.boundary_betti);
        REQUIRE(boundary.euler_characteristic() == 2 * complex.euler_characteristic());
        // Eq. (6.15), corrected to several components of the boundary.
        REQUIRE(row.betti[1] == row.betti[0] + row.betti[2] - boundary.euler_characteristic() / 2);
    }
}

TEST_CASE("CellComplex: the counts of Fig. 6.1 (B)", "[meshing][topology]") {
    const auto complex = make_hexahedron_complex(
        make_voxels(3, 3, 1, [](int x, int y, int) { return x != 1 || y != 1; }));
    REQUIRE(complex.dimension() == 3);
    REQUIRE(complex.n_cells(0) == 32);
    REQUIRE(complex.n_cells(1) == 64);
    REQUIRE(complex.n_cells(2) == 40);
    REQUIRE(complex.n_cells(3) == 8);
    REQUIRE(complex.euler_characteristic() == 0);
}

TEST_CASE("CellComplex: the boundary of the tesseract is a 3-sphere, its valences don't sum to chi",
          "[meshing][topology]") {
    const auto complex = make_hexahedron_complex(make_tesseract_boundary());
    REQUIRE(complex.n_cells(0) == 16);
    REQUIRE(complex.n_cells(1) == 32);
    REQUIRE(complex.n_cells(2) == 24);
    REQUIRE(betti_numbers(complex) == std::vector<int>{1, 0, 0, 1});
    REQUIRE(complex.euler_characteristic() == 0);
    REQUIRE_THROWS_WITH(boundary_complex(complex), Catch::Contains("the complex is closed"));
    // [Maquart19] conjecture 6.1, Eq. (6.18), says 0.
    std::vector<int> valence(16, 0);
    for (const auto& edge : complex.boundary(1).columns) {
        for (const auto& end : edge) ++valence[end.row];
    }
    double sum = 0.0;
    for (const int v : valence) sum += 1.0 - v / 6.0;
    REQUIRE(sum == Approx(16.0 / 3.0));
}

TEST_CASE("CellComplex: torsion shows modulo 2 only", "[meshing][topology]") {
    // The projective plane with six vertices.
    const std::vector<std::array<int, 3>> plane{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5},
                                                {0, 5, 1}, {1, 2, 4}, {2, 3, 5}, {3, 4, 1},
                                                {4, 5, 2}, {5, 1, 3}};
    const auto complex = make_triangle_complex(plane);
    REQUIRE(complex.euler_characteristic() == 1);
    REQUIRE(betti_numbers(complex) == std::vector<int>{1, 0, 0});
    REQUIRE(betti_numbers(complex, 2) == std::vector<int>{1, 1, 1});
    REQUIRE(betti_numbers(complex, 3) == std::vector<int>{1, 0, 0});
}

TEST_CASE("CellComplex: quads and tetrahedra", "[meshing][topology]") {
    std::vector<std::array<int, 4>> quads;
    for (int i = 0; i < 4; ++i) {
        for (int j = 0; j < 5; ++j) {
            const auto at = [](int a, int b) { return 10 * (a % 4) + b % 5; };
            quads.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    }
    REQUIRE(betti_numbers(make_quad_complex(quads)) == std::vector<int>{1, 2, 1});
    quads.pop_back();
    REQUIRE(betti_numbers(make_quad_complex(quads)) == std::vector<int>{1, 2, 0});
    const std::vector<std::array<int, 4>> pair{{0, 1, 2, 3}, {1, 2, 3, 4}};
    const auto complex = make_tetrahedron_complex(pair);
    REQUIRE(complex.n_cells(2) == 7);
    REQUIRE(betti_numbers(complex) == std::vector<int>{1, 0, 0, 0});
    REQUIRE(boundary_complex(complex).n_cells(2) == 6);
    REQUIRE_NOTHROW(check_volume_boundary(complex));
}

TEST_CASE("CellComplex: thousands of cells take no time", "[meshing][topology]") {
    const auto complex = make_hexahedron_complex(
        make_voxels(17, 17, 17, [](int x, int y, int z) { return x % 2 + y % 2 + z % 2 < 2; }));
    const auto betti = betti_numbers(complex);
    REQUIRE(betti[0] == 1);
    REQUIRE(betti[0] - betti[1] + betti[2] == complex.euler_characteristic());
    // A lattice of bars: loops are edges - nodes + 1.
    REQUIRE(betti[1] == 3 * 8 * 81 - 729 + 1);
    REQUIRE(betti[2] == 0);
}

TEST_CASE("CellComplex: what is no complex is refused", "[meshing][topology]") {
    const std::vector<std::array<int, 3>> none;
    REQUIRE_THROWS_WITH(make_triangle_complex(none), Catch::Contains("there are no cells"));
    const std::vector<std::array<int, 3>> twice{{0, 1, 2}, {3, 4, 3}};
    REQUIRE_THROWS_AS(make_triangle_complex(twice), InputError);
    REQUIRE_THROWS_WITH(make_triangle_complex(twice), Catch::Contains("cell 1 has vertex 3 twice"));
    const std::vector<std::array<int, 3>> negative{{0, 1, -2}};
    REQUIRE_THROWS_WITH(make_triangle_complex(negative), Catch::Contains("cell 0 has vertex -2;"));
    Hexahedra crossed{{0, 1, 2, 3, 4, 5, 6, 7}, {4, 5, 7, 6, 8, 9, 10, 11}};
    REQUIRE_THROWS_WITH(make_hexahedron_complex(crossed), Catch::Contains("must share its edges"));

    REQUIRE_THROWS_WITH(CellComplex({}), Catch::Contains("there are no boundary operators"));
    BoundaryOperator edges{.n_rows = 3,
                           .columns = {{{0, -1}, {1, 1}}, {{1, -1}, {2, 1}}, {{0, -1}, {2, 1}}}};
    BoundaryOperator face{.n_rows = 3, .columns = {{{0, 1}, {1, 1}, {2, 1}}}};
    REQUIRE_THROWS_AS(CellComplex({edges, face}), TopologyError);
    REQUIRE_THROWS_WITH(CellComplex({edges, face}),
                        Catch::Contains("boundary of the boundary of cell 0 of dimension 2"));
    face.columns[0][2].value = -1;
    REQUIRE_NOTHROW(CellComplex({edges, face}));
    face.n_rows = 4;
    REQUIRE_THROWS_WITH(CellComplex({edges, face}), Catch::Contains("has 4 rows"));
    edges.columns[0][1].row = 7;
    REQUIRE_THROWS_WITH(CellComplex({edges}), Catch::Contains("lists cell 7"));

    const auto touching =
        make_hexahedron_complex(make_voxels(2, 2, 1, [](int x, int y, int) { return x == y; }));
    REQUIRE_THROWS_AS(check_volume_boundary(touching), TopologyError);
    REQUIRE_THROWS_WITH(check_volume_boundary(touching), Catch::Contains("touch only along"));
    REQUIRE_THROWS_WITH(betti_numbers(touching, 6), Catch::Contains("the modulus is 6"));
}
