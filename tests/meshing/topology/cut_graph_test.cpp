#include "meshing/topology/cut_graph.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <map>
#include <numbers>
#include <set>

#include "iga/core/error.h"
#include "meshing/parts/part_surface.h"
#include "meshing/surface/harmonic_map.h"
#include "meshing/topology/homology_basis.h"
#include "meshing/topology/integer_lattice.h"
#include "tests/data_folder.h"
#include "tests/meshing/surface/map_samples.h"
#include "tests/meshing/surface/public_surfaces.h"
#include "tests/meshing/surface/surface_samples.h"

using namespace couture;
using namespace couture::meshing;

namespace {

void require_disc(const CutSurface& surface) {
    REQUIRE(surface.euler_characteristic() == 1);
    REQUIRE(surface.boundary_loops().size() == 1);
    const auto component = surface.face_components();
    REQUIRE(*std::max_element(component.begin(), component.end()) == 0);
}

// A cut graph opens to a disc, and every end of it lies on the boundary.
void require_cut_graph(const CutSurface& surface) {
    const std::vector<int> edges = cut_graph(surface);
    std::map<int, int> degree;
    for (const int h : edges) {
        REQUIRE(surface.twin(h) > h);
        ++degree[surface.origin(h)];
        ++degree[surface.target(h)];
    }
    const bool is_sphere = surface.euler_characteristic() == 2;
    for (const auto& [v, n] : degree) {
        if (!is_sphere && n == 1) REQUIRE(surface.is_boundary_vertex(v));
    }
    require_disc(open_to_disc(surface));
}

void require_system(const CutSurface& surface, int base) {
    const auto loops = system_of_loops(surface, base);
    const int rank = 2 - surface.euler_characteristic();
    REQUIRE(static_cast<int>(loops.size()) == rank);
    std::set<int> edges;
    double before = 0.0;
    for (const auto& loop : loops) {
        double length = 0.0;
        for (std::size_t k = 0; k < loop.size(); ++k) {
            REQUIRE(surface.target(loop[k]) == surface.origin(loop[(k + 1) % loop.size()]));
            edges.insert(std::min(loop[k], surface.twin(loop[k])));
            length += surface.length(loop[k]);
        }
        REQUIRE(surface.origin(loop.front()) == base);
        REQUIRE(length >= before * (1.0 - 1e-12));
        before = length;
    }
    if (rank == 0) return;
    const HomologyBasis basis = make_homology_basis(surface);
    IntegerMatrix classes;
    for (const auto& loop : loops) {
        const auto c = basis.annotated.class_of(loop);
        classes.emplace_back(c.begin(), c.end());
    }
    REQUIRE(std::llabs(determinant(classes)) == 1);
    CutSurface disc = surface;
    disc.slice(std::vector<int>(edges.begin(), edges.end()));
    require_disc(disc);
}

double length_of(const CutSurface& surface, const std::vector<int>& edges) {
    double length = 0.0;
    for (const int h : edges) length += surface.length(h);
    return length;
}

}  // namespace

TEST_CASE("cut graph: a tube opens along a straight line, a square not at all",
          "[meshing][topology]") {
    const CutSurface tube(make_tube(8, 4, 1.0, 2.0));
    const auto edges = cut_graph(tube);
    CHECK(edges.size() == 4);
    CHECK(length_of(tube, edges) == Approx(2.0));
    require_cut_graph(tube);
    CHECK(cut_graph(CutSurface(make_square(3))).empty());
    require_disc(open_to_disc(CutSurface(make_square(3))));
}

TEST_CASE("cut graph: a torus opens along a meridian and a longitude", "[meshing][topology]") {
    const CutSurface torus(make_torus(24, 16, 2.0, 0.5));
    require_cut_graph(torus);
    const auto loops = system_of_loops(torus, 5);
    // A regular polygon of 16 corners.
    CHECK(length_of(torus, loops.front()) ==
          Approx(16.0 * std::sin(std::numbers::pi / 16.0)).epsilon(1e-12));
    // Vertices less edges of a connected graph with two independent cycles.
    const auto edges = cut_graph(torus);
    std::set<int> vertices;
    for (const int h : edges) vertices.insert({torus.origin(h), torus.target(h)});
    CHECK(static_cast<int>(vertices.size()) - static_cast<int>(edges.size()) == -1);
}

TEST_CASE("cut graph: spheres, tori with boundaries, plates with holes", "[meshing][topology]") {
    require_cut_graph(CutSurface(make_tetrahedron()));
    require_cut_graph(CutSurface(make_cube(4)));
    for (const int genus : {1, 2, 5}) {
        TriangleSoup soup = make_plate_with_holes(genus, 3);
        require_cut_graph(CutSurface(soup));
        require_system(CutSurface(soup), 7);
        // Without three triangles that don't touch.
        for (const int f : {200, 100, 0}) soup.triangles.erase(soup.triangles.begin() + f);
        const CutSurface open(soup);
        REQUIRE(open.boundary_loops().size() == 3);
        REQUIRE(open.euler_characteristic() == 2 - 2 * genus - 3);
        require_cut_graph(open);
    }
}

TEST_CASE("cut graph: parts", "[meshing][topology]") {
    for (const auto& [name, edge_length] :
         std::map<std::string, double>{{"casting", 12.0}, {"double_torus", 5.0}, {"wheel", 9.0}}) {
        INFO(name);
        const CutSurface surface(make_part_surface(name, {}, edge_length).soup);
        require_cut_graph(surface);
        require_system(surface, surface.n_vertices() / 2);
    }
}

TEST_CASE("cut graph: public surfaces open to discs that map one-to-one", "[meshing][topology]") {
    const auto folder = test::data_folder();
    if (!folder) return;
    for (const std::string& file : public_surface_files()) {
        INFO(file);
        const CutSurface surface(read_surface(*folder / "surfaces" / file));
        require_cut_graph(surface);
        CutSurface disc = open_to_disc(surface);
        const HarmonicMap map =
            map_disc_to_polygon(disc, spread_corners(disc, 4), square_corners());
        REQUIRE(flipped_triangles(disc, map.parameters).empty());
        if (surface.boundary_loops().empty()) require_system(surface, surface.origin(0));
    }
}

TEST_CASE("cut graph: errors say what is wrong", "[meshing][topology]") {
    TriangleSoup far = make_cube(1);
    for (auto& point : far.points) point[0] += 5.0;
    const CutSurface two(join(make_cube(1), far));
    REQUIRE_THROWS_WITH(cut_graph(two),
                        "cut_graph: the surface has 2 components; it must be in one piece");
    REQUIRE_THROWS_WITH(open_to_disc(CutSurface()),
                        "cut_graph: the surface has 0 components; it must be in one piece");
    REQUIRE_THROWS_WITH(system_of_loops(two, 0),
                        "system_of_loops: the surface has 2 components; it must be in one piece");
    REQUIRE_THROWS_WITH(system_of_loops(CutSurface(make_square(2)), 0),
                        "system_of_loops: the surface has 1 boundaries; close it first, or use "
                        "cut_graph");
    REQUIRE_THROWS_WITH(system_of_loops(CutSurface(make_cube(1)), 8),
                        "system_of_loops: base 8 is no vertex of a triangle; there are 8");
}
