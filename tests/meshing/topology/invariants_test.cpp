#include "meshing/topology/invariants.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "iga/core/error.h"
#include "meshing/topology/cell_complex.h"
#include "tests/data_folder.h"
#include "tests/meshing/surface/public_surfaces.h"
#include "tests/meshing/surface/surface_samples.h"

using namespace couture;
using namespace couture::meshing;

namespace {

// Without the triangles that are named.
TriangleSoup without(TriangleSoup soup, const std::vector<int>& triangles) {
    for (auto i = triangles.rbegin(); i != triangles.rend(); ++i) {
        soup.triangles.erase(soup.triangles.begin() + *i);
    }
    return soup;
}

TriangleSoup make_moebius_strip() {
    TriangleSoup soup;
    for (int i = 0; i < 5; ++i) {
        soup.points.emplace_back(i, 0.0, 0.0);
        soup.triangles.push_back({i, (i + 1) % 5, (i + 2) % 5});
    }
    return soup;
}

}  // namespace

TEST_CASE("Invariants: table of surfaces", "[meshing][topology]") {
    struct Row {
        TriangleSoup soup;
        int genus, n_boundaries, chi;
        std::array<int, 3> betti;
        std::string name;
    };
    const std::vector<Row> rows{
        {make_tetrahedron(), 0, 0, 2, {1, 0, 1}, "sphere"},
        {make_cube(3), 0, 0, 2, {1, 0, 1}, "sphere"},
        {make_square(4), 0, 1, 1, {1, 0, 0}, "disc"},
        {make_tube(7, 3, 1.0, 2.0), 0, 2, 0, {1, 1, 0}, "cylinder"},
        {make_torus(9, 7, 2.0, 0.7), 1, 0, 0, {1, 2, 1}, "torus"},
        {without(make_cube(3), {0, 30, 90}), 0, 3, -1, {1, 2, 0}, "pant"},
        {without(make_cube(3), {0, 30, 60, 90}), 0, 4, -2, {1, 3, 0}, "4-pant"},
        {without(make_torus(9, 7, 2.0, 0.7), {0}), 1, 1, -1, {1, 2, 0}, "genus 1 with 1 boundary"},
        {without(make_plate_with_holes(2, 2), {0, 40}),
         2,
         2,
         -4,
         {1, 5, 0},
         "genus 2 with 2 boundaries"},
        {make_plate_with_holes(3, 1), 3, 0, -4, {1, 6, 1}, "genus 3"},
        {join(make_square(2), make_torus(9, 7, 2.0, 0.7)),
         1,
         1,
         1,
         {2, 2, 1},
         "2 components: disc, torus"},
    };
    for (const Row& row : rows) {
        CAPTURE(row.name);
        const SurfaceMesh mesh = make_surface_mesh(row.soup);
        const SurfaceInvariants invariants = compute_invariants(mesh);
        REQUIRE(invariants.genus == row.genus);
        REQUIRE(invariants.n_boundaries == row.n_boundaries);
        REQUIRE(invariants.euler_characteristic == row.chi);
        REQUIRE(invariants.betti == row.betti);
        REQUIRE(surface_name(mesh) == row.name);
        REQUIRE(boundary_loops(mesh).size() == static_cast<std::size_t>(row.n_boundaries));
        // By another way: ranks of the boundary operators.
        const auto ranks = betti_numbers(make_triangle_complex(row.soup.triangles));
        REQUIRE(ranks == std::vector<int>(row.betti.begin(), row.betti.end()));
        REQUIRE_NOTHROW(check_gauss_bonnet(mesh));
        REQUIRE(orientation_of(row.soup) == Orientation::consistent);
    }
}

TEST_CASE("Invariants: vertices without triangles don't count", "[meshing][topology]") {
    TriangleSoup soup = make_cube(2);
    soup.points.emplace_back(9.0, 9.0, 9.0);
    const SurfaceMesh mesh = make_surface_mesh(soup);
    REQUIRE(compute_invariants(mesh).euler_characteristic == 2);
    REQUIRE_NOTHROW(check_gauss_bonnet(mesh));
    REQUIRE(compute_invariants(SurfaceMesh()).n_components == 0);
}

TEST_CASE("Invariants: two fans at a vertex are refused", "[meshing][topology]") {
    TriangleSoup soup;
    soup.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {-1, 0, 0}, {-1, -1, 0}};
    soup.triangles = {{0, 1, 2}, {0, 3, 4}};
    const SurfaceMesh mesh = make_surface_mesh(soup);
    REQUIRE_THROWS_AS(compute_invariants(mesh), TopologyError);
    REQUIRE_THROWS_WITH(compute_invariants(mesh),
                        Catch::Contains("vertex 0 at (0, 0, 0) form more than one fan"));
}

TEST_CASE("Invariants: pants are counted where there are any", "[meshing][topology]") {
    REQUIRE(count_pants(0, 3).n_pants == 1);
    REQUIRE(count_pants(0, 3).n_curves == 0);
    REQUIRE(count_pants(2, 0).n_pants == 2);
    REQUIRE(count_pants(2, 0).n_curves == 3);
    REQUIRE(count_pants(3, 2).n_pants == 6);
    REQUIRE(count_pants(3, 2).n_curves == 8);
    // Each pant has three boundaries: a curve is two of them.
    for (int genus = 0; genus < 5; ++genus) {
        for (int b = 0; b < 5; ++b) {
            if (2 - 2 * genus - b > -1) {
                REQUIRE_THROWS_AS(count_pants(genus, b), TopologyError);
                continue;
            }
            const PantsCount count = count_pants(genus, b);
            REQUIRE(3 * count.n_pants == 2 * count.n_curves + b);
        }
    }
    REQUIRE_THROWS_WITH(count_pants(0, 2), Catch::Contains("a cylinder (genus 0, 2 boundaries) has "
                                                           "chi = 0"));
    REQUIRE_THROWS_WITH(surface_name(-1, 2), Catch::Contains("genus -1 with 2 boundaries"));
}

TEST_CASE("Invariants: boundary loops in order, with length and centre", "[meshing][topology]") {
    const int n = 12;
    const SurfaceMesh mesh = make_surface_mesh(make_tube(n, 3, 1.0, 2.0));
    const auto loops = boundary_loops(mesh);
    REQUIRE(loops.size() == 2);
    for (const auto& loop : loops) {
        REQUIRE(loop.vertices.size() == static_cast<std::size_t>(n));
        REQUIRE(loop.length == Approx(2.0 * n * std::sin(std::numbers::pi / n)));
        for (int i = 0; i < n; ++i) {
            const HalfedgeHandle halfedge =
                mesh.find_halfedge(loop.vertices[i], loop.vertices[(i + 1) % n]);
            REQUIRE(halfedge.is_valid());
            REQUIRE_FALSE(mesh.is_boundary(halfedge));
        }
    }
    REQUIRE(loops[0].vertices.front().idx() == 0);
    REQUIRE(loops[0].center.norm() < 1e-14);
    REQUIRE((loops[1].center - Vector3(0, 0, 2)).norm() < 1e-14);
}

TEST_CASE("Invariants: Gauss-Bonnet blames a triangle without extent", "[meshing][topology]") {
    TriangleSoup soup = make_cube(2);
    REQUIRE(std::abs(gauss_bonnet_defect(make_surface_mesh(soup))) < 1e-12);
    const auto [a, b, c] = soup.triangles[5];
    soup.points[a] = soup.points[b];
    const SurfaceMesh mesh = make_surface_mesh(soup);
    REQUIRE_THROWS_AS(check_gauss_bonnet(mesh), TopologyError);
    REQUIRE_THROWS_WITH(check_gauss_bonnet(mesh),
                        Catch::Contains("total curvature - 2 pi chi") && Catch::Contains("sum to"));
}

TEST_CASE("Invariants: a soup is oriented, can be, or cannot", "[meshing][topology]") {
    TriangleSoup soup = make_cube(2);
    std::swap(soup.triangles[3][0], soup.triangles[3][1]);
    REQUIRE(orientation_of(soup) == Orientation::inconsistent);
    REQUIRE(orientation_of(make_moebius_strip()) == Orientation::impossible);
    soup = make_square(1);
    soup.points.emplace_back(0.0, 0.0, 1.0);
    soup.triangles.push_back({0, 3, 4});
    REQUIRE(orientation_of(soup) == Orientation::impossible);
}

TEST_CASE("Invariants: public surfaces have those of their list and obey Gauss-Bonnet",
          "[meshing][topology][data]") {
    const auto folder = test::data_folder();
    if (!folder) return;
    for (const auto& surface : public_surfaces()) {
        CAPTURE(surface.file);
        const TriangleSoup soup = read_off(*folder / "surfaces" / surface.file);
        const SurfaceMesh mesh = make_surface_mesh(soup);
        const auto invariants = compute_invariants(mesh);
        REQUIRE(mesh.n_vertices() == static_cast<std::size_t>(surface.n_vertices));
        REQUIRE(invariants.genus == surface.genus);
        REQUIRE(invariants.n_boundaries == surface.n_boundaries);
        REQUIRE(invariants.euler_characteristic == surface.euler_characteristic);
        REQUIRE_NOTHROW(check_gauss_bonnet(mesh));
    }
}
