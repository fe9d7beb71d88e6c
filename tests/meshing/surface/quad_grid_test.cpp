#include "meshing/surface/quad_grid.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <map>

#include "iga/core/error.h"
#include "meshing/surface/harmonic_map.h"
#include "tests/meshing/surface/map_samples.h"
#include "tests/meshing/surface/surface_samples.h"

using namespace couture;
using namespace couture::meshing;

namespace {

// The torus of make_torus cut along the tube's circle and the outer circle through vertex 0, with
// the corners of the disc from one where the side along the outer circle starts.
struct OpenTorus {
    CutSurface surface;
    std::vector<int> corners;
};

OpenTorus open_torus(int n_around, int n_tube) {
    OpenTorus torus{CutSurface(make_torus(n_around, n_tube, 2.0, 0.7)), {}};
    CutSurface& surface = torus.surface;
    const SurfaceMesh mesh = make_surface_mesh(make_torus(n_around, n_tube, 2.0, 0.7));
    std::vector<bool> is_seam(mesh.n_edges(), false);
    const auto mark = [&](int u, int v) {
        is_seam[mesh.edge_handle(mesh.find_halfedge(VertexHandle(u), VertexHandle(v))).idx()] =
            true;
    };
    for (int j = 0; j < n_tube; ++j) mark(j, (j + 1) % n_tube);
    for (int i = 0; i < n_around; ++i) mark(n_tube * i, n_tube * ((i + 1) % n_around));
    const std::vector<FaceHandle> faces(mesh.faces_begin(), mesh.faces_end());
    surface = CutSurface(mesh, faces, is_seam);
    const auto loop = surface.boundary_loops().front();
    // The first corner has the outer circle behind it.
    std::size_t start = 0;
    while (surface.parent(surface.origin(loop[start])) != 0 ||
           surface.parent(surface.target(loop[start])) < n_tube) {
        ++start;
    }
    for (std::size_t i = 0; i < loop.size(); ++i) {
        const int v = surface.origin(loop[(start + i) % loop.size()]);
        if (surface.parent(v) == 0) torus.corners.push_back(v);
    }
    return torus;
}

double distance_from_torus(const Vector3& p) {
    return std::abs(std::hypot(std::hypot(p.x(), p.y()) - 2.0, p.z()) - 0.7);
}

// Largest distance from the exact torus of a grid on a torus of n x n / 2 squares.
double torus_error(int n, int n_quads) {
    OpenTorus torus = open_torus(n, n / 2);
    REQUIRE(torus.surface.euler_characteristic() == 1);
    REQUIRE(torus.corners.size() == 4);
    HarmonicMap harmonic = map_disc_to_polygon(torus.surface, torus.corners, square_corners());
    const PlanarMap map(torus.surface, std::move(harmonic.parameters));
    const QuadMesh quads = extract_quad_grid(
        map, {0.0, 0.0}, {1.0, 1.0},
        {.n_u = n_quads, .n_v = n_quads / 2, .is_closed_u = true, .is_closed_v = true});

    // Closed, oriented, genus 1, regular.
    REQUIRE(quads.points.size() == static_cast<std::size_t>(n_quads * (n_quads / 2)));
    REQUIRE(quads.quads.size() == quads.points.size());
    std::map<std::pair<int, int>, int> sides;
    std::vector<int> valence(quads.points.size(), 0);
    for (const auto& quad : quads.quads) {
        for (int k = 0; k < 4; ++k) {
            ++sides[{quad[k], quad[(k + 1) % 4]}];
            ++valence[quad[k]];
        }
    }
    for (const auto& [side, count] : sides) {
        REQUIRE(count == 1);
        REQUIRE(sides.contains({side.second, side.first}));
    }
    for (const int v : valence) REQUIRE(v == 4);
    const auto n_edges = static_cast<int>(sides.size() / 2);
    REQUIRE(static_cast<int>(quads.points.size()) - n_edges +
                static_cast<int>(quads.quads.size()) ==
            0);
    // Outwards.
    double volume = 0.0;
    for (const auto& q : quads.quads) {
        const auto& p = quads.points;
        volume += p[q[0]].dot(p[q[1]].cross(p[q[2]])) / 6.0;
        volume += p[q[0]].dot(p[q[2]].cross(p[q[3]])) / 6.0;
    }
    REQUIRE(volume > 0.0);
    double error = 0.0;
    for (const Vector3& point : quads.points) error = std::max(error, distance_from_torus(point));
    return error;
}

}  // namespace

TEST_CASE("extract_quad_grid: a torus cut to a square and closed again", "[meshing][surface]") {
    // Fig. 2.14: the points lie on the triangles, whose sagitta falls with the square of their
    // size.
    const double coarse = torus_error(24, 14);
    const double middle = torus_error(48, 14);
    const double fine = torus_error(96, 14);
    CHECK(coarse < 0.05);
    CHECK(middle < coarse / 3.0);
    CHECK(fine < middle / 3.0);
}

TEST_CASE("extract_quad_grid: points lie on the surface, numbered row by row",
          "[meshing][surface]") {
    CutSurface surface(make_jittered_square(7, 3));
    HarmonicMap harmonic =
        map_disc_to_polygon(surface, square_corner_vertices(7), rectangle_corners(2.0, 2.0));
    const PlanarMap map(surface, std::move(harmonic.parameters));
    const QuadMesh quads = extract_quad_grid(map, {0.0, 0.0}, {2.0, 2.0}, {.n_u = 5, .n_v = 3});
    REQUIRE(quads.points.size() == 24);
    REQUIRE(quads.quads.size() == 15);
    CHECK(quads.quads[0] == std::array<int, 4>{0, 1, 7, 6});
    for (int j = 0; j <= 3; ++j) {
        for (int i = 0; i <= 5; ++i) {
            CHECK((quads.points[6 * j + i] - Vector3(i / 5.0, j / 3.0, 0.0)).norm() < 1e-12);
        }
    }
}

TEST_CASE("extract_quad_grid: errors say what is wrong", "[meshing][surface]") {
    CutSurface surface(make_square(3));
    HarmonicMap harmonic =
        map_disc_to_polygon(surface, square_corner_vertices(3), square_corners());
    const PlanarMap map(surface, std::move(harmonic.parameters));
    const auto extract = [&](const Vector2& low, const Vector2& high,
                             const QuadGridOptions& options) {
        return extract_quad_grid(map, low, high, options);
    };
    REQUIRE_THROWS_WITH(extract({0, 0}, {1, 1}, {.n_u = 0}),
                        "extract_quad_grid: 0 quads along u; there must be 1 or more");
    REQUIRE_THROWS_WITH(extract({0, 0}, {1, 1}, {.n_v = 2, .is_closed_v = true}),
                        "extract_quad_grid: 2 quads along v; there must be 3 or more in a closed "
                        "direction");
    REQUIRE_THROWS_WITH(extract({0, 1}, {1, 0}, {}),
                        "extract_quad_grid: [0, 1] x [1, 0]; low must lie below high");
    REQUIRE_THROWS_WITH(extract({0, 0}, {2, 1}, {}), Catch::Contains("lies outside the map"));
    REQUIRE_THROWS_WITH(extract({0, 0}, {1, 1}, {.is_closed_u = true}),
                        Catch::Contains("points (0, 0) and (8, 0) of the grid are 1 apart"));
}
