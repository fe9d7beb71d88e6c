#include "meshing/surface/shortest_paths.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "tests/meshing/surface/map_samples.h"
#include "tests/meshing/surface/surface_samples.h"

using namespace couture;
using namespace couture::meshing;

TEST_CASE("shortest paths: along a square's side, or beside it", "[meshing][surface]") {
    const CutSurface square(make_square(4));
    const int corner = 0;
    ShortestPaths paths(square);
    paths.run({.sources = {&corner, 1}, .takes_boundary_edges = true});
    CHECK(paths.distance(4) == Approx(1.0));
    CHECK(paths.vertices_to(4) == std::vector<int>{0, 1, 2, 3, 4});
    // One diagonal up and three steps along; down again there is only the side itself: the corner
    // has no other edge.
    paths.run({.sources = {&corner, 1}});
    CHECK(paths.distance(4) == std::numeric_limits<double>::infinity());
    CHECK(paths.distance(9) == Approx(0.25 * (3.0 + std::sqrt(2.0))));
}

TEST_CASE("shortest paths: prepared or not, the same to the last bit", "[meshing][surface]") {
    const CutSurface surface(make_bumpy_square(12, 0.4));
    std::vector<double> factor;
    for (int v = 0; v < surface.n_vertices(); ++v) factor.push_back(1.0 + 0.1 * (v % 7));
    ShortestPaths plain(surface, &factor);
    ShortestPaths prepared(surface, &factor);
    prepared.prepare();
    for (const bool takes_boundary_edges : {false, true}) {
        for (const int source : {0, 6, 84}) {
            const ShortestPaths::Search search{.sources = {&source, 1},
                                               .takes_boundary_edges = takes_boundary_edges};
            plain.run(search);
            prepared.run(search);
            REQUIRE(prepared.settled() == plain.settled());
            for (const int v : plain.settled()) {
                REQUIRE(prepared.distance(v) == plain.distance(v));
                REQUIRE(prepared.vertices_to(v) == plain.vertices_to(v));
                REQUIRE(prepared.path_to(v) == plain.path_to(v));
            }
        }
    }
}
