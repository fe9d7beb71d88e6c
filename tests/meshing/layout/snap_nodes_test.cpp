#include "meshing/layout/snap_nodes.h"

#include <catch2/catch.hpp>

#include "iga/core/error.h"
#include "meshing/parts/part_surface.h"

using namespace couture;
using namespace couture::meshing;
using Catch::Matchers::Contains;

namespace {

const std::vector<std::string> names{"a", "b", "c", "d", "e", "f", "g", "h"};
// Of the cube.
constexpr double length = 50.0;
constexpr double rounding = 1e-12;

struct Cube {
    SurfaceMesh mesh = make_surface_mesh(make_part_surface("cube", {{"length", length}}).soup);
    Features features = detect_features(mesh);
};

PlacedLayout box() {
    PlacedLayout placed{{8, {{0, 1, 2, 3, 4, 5, 6, 7}}, {}}, {}};
    for (int k = 0; k < 8; ++k) {
        placed.positions.push_back(length * Vector3(k & 1, k >> 1 & 1, k >> 2 & 1));
    }
    return placed;
}

}  // namespace

TEST_CASE("snap_nodes: to corners first, then to sharp edges, then to the surface", "[layout]") {
    Cube cube;
    const std::size_t n_vertices = cube.mesh.n_vertices();
    PlacedLayout placed = box();
    placed.positions[0] = Vector3(0.5, -0.5, 0.5);
    placed.positions[1] = Vector3(30.0, 0.3, -0.4);
    placed.positions[2] = Vector3(20.0, 40.0, -0.7);
    const auto snapped = snap_nodes(cube.mesh, cube.features, placed, names, 1.0).positions;
    CHECK(snapped[0].norm() < rounding);
    CHECK((snapped[1] - Vector3(30.0, 0.0, 0.0)).norm() < rounding);
    CHECK((snapped[2] - Vector3(20.0, 40.0, 0.0)).norm() < rounding);
    for (int k = 3; k < 8; ++k) CHECK((snapped[k] - placed.positions[k]).norm() < rounding);
    // On the edge there is a vertex now, and the edge is still sharp.
    CHECK(cube.mesh.n_vertices() <= n_vertices + 1);
    int n_sharp = 0;
    for (const auto vertex : cube.mesh.vertices()) {
        if ((cube.mesh.point(vertex) - snapped[1]).norm() > rounding) continue;
        for (const auto edge : cube.mesh.ve_range(vertex)) {
            n_sharp += cube.mesh.data(edge).feature >= 0 ? 1 : 0;
        }
    }
    CHECK(n_sharp == 2);
    // With less tolerance than its distance from the edge, a node stays in its face.
    PlacedLayout beside = box();
    beside.positions[1] = Vector3(30.0, 0.3, 0.0);
    const auto kept = snap_nodes(cube.mesh, cube.features, beside, names, 0.1).positions;
    for (int k = 0; k < 8; ++k) CHECK((kept[k] - beside.positions[k]).norm() < rounding);
}

TEST_CASE("snap_nodes: nodes far away or at one place are named", "[layout]") {
    Cube cube;
    PlacedLayout placed = box();
    placed.positions[3] = Vector3(length, length, -4.0);
    CHECK_THROWS_WITH(snap_nodes(cube.mesh, cube.features, placed, names, 1.0),
                      Contains("node 'd' at (50, 50, -4) lies 4 from the surface") &&
                          Contains("'tolerance' = 1") &&
                          Contains("the nearest place is (50, 50, 0): move the node"));
    placed.positions[3] = Vector3(0.3, 0.0, 0.0);
    CHECK_THROWS_WITH(snap_nodes(cube.mesh, cube.features, placed, names, 1.0),
                      Contains("nodes 'a' and 'd' both come to (0, 0, 0)"));
    CHECK_THROWS_WITH(snap_nodes(cube.mesh, cube.features, box(), names, 0.0),
                      Contains("tolerance 0; it must be positive"));
}
