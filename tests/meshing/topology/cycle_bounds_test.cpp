#include "meshing/topology/cycle_bounds.h"

#include <catch2/catch.hpp>

#include "meshing/surface/surface_curves.h"
#include "meshing/topology/homotopic_cycle.h"
#include "meshing/topology/pants.h"
#include "tests/meshing/surface/surface_samples.h"

using namespace couture::meshing;

namespace {

// What is left of a plate with holes in a row once its handles are cut: a sphere with 2 genus
// boundaries.
struct CutPlate {
    CutPlate(int genus, int n) : mesh(make_surface_mesh(make_plate_with_holes(genus, n))) {
        static_cast<void>(decompose_into_pants(mesh, {.only_handles = true}));
        const std::vector<FaceHandle> faces(mesh.faces_begin(), mesh.faces_end());
        piece = CutSurface(mesh, faces, curve_seams(mesh));
    }
    SurfaceMesh mesh;
    CutSurface piece;
};

}  // namespace

TEST_CASE("CycleBounds: no cycle is shorter, however coarse the mesh", "[meshing][topology]") {
    const int n = GENERATE(1, 2, 3);
    const CutPlate plate(4, n);
    const HomotopicCycles cycles(plate.piece);
    const CycleBounds bounds(plate.piece, cycles.loops());
    const int n_loops = static_cast<int>(cycles.loops().size());
    REQUIRE(n_loops == 8);
    int n_above_shortest = 0;
    double shortest = cycles.find(0, 1).weight;
    for (int i = 0; i < n_loops; ++i) {
        for (int j = i + 1; j < n_loops; ++j) {
            const double length = cycles.find(i, j).weight;
            shortest = std::min(shortest, length);
            REQUIRE(bounds.length_around(i, j) <= (1.0 + 1e-12) * length);
            REQUIRE(bounds.length_around(i, j) == bounds.length_around(j, i));
        }
    }
    for (int i = 0; i < n_loops; ++i) {
        for (int j = i + 1; j < n_loops; ++j) {
            n_above_shortest += bounds.length_around(i, j) > shortest;
        }
    }
    // Of the 28 pairs these need not be looked at.
    CAPTURE(n);
    REQUIRE(n_above_shortest >= 8);
}

TEST_CASE("pants: the first cycle is the shortest of all pairs", "[meshing][topology]") {
    const int n = GENERATE(1, 2, 3);
    const int genus = GENERATE(3, 4);
    const CutPlate plate(genus, n);
    const HomotopicCycles cycles(plate.piece);
    double shortest = cycles.find(0, 1).weight;
    for (int i = 0; i < 2 * genus; ++i) {
        for (int j = i + 1; j < 2 * genus; ++j) {
            shortest = std::min(shortest, cycles.find(i, j).weight);
        }
    }
    SurfaceMesh mesh = make_surface_mesh(make_plate_with_holes(genus, n));
    const PantsDecomposition pants = decompose_into_pants(mesh);
    REQUIRE(pants.curves[genus].length == Approx(shortest).epsilon(1e-9));
}
