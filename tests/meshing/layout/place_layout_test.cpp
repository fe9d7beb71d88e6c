#include "meshing/layout/place_layout.h"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <utility>

#include "iga/core/error.h"
#include "meshing/parts/part_surface.h"
#include "meshing/parts/parts.h"
#include "meshing/pipeline/rounded_edges.h"
#include "meshing/pipeline/solid_mesh.h"
#include "tests/meshing/layout/layout_samples.h"

using namespace couture;
using namespace couture::meshing;

namespace {

// The corners of a spline part's patches.
PlacedLayout cuboids_of(const std::string& name) {
    const auto volume = std::get<iga::MultiPatch<3>>(make_part(name));
    const double tolerance = 1e-6 * volume.size();
    PlacedLayout placed;
    for (const iga::Patch<3>& patch : volume.patches) {
        auto& nodes = placed.layout.cuboids.emplace_back();
        for (int k = 0; k < 8; ++k) {
            const Vector3 x = patch.point(Vector3(k & 1, k >> 1 & 1, k >> 2 & 1));
            int node = 0;
            while (node < placed.layout.n_nodes &&
                   (placed.positions[node] - x).norm() > tolerance) {
                ++node;
            }
            if (node == placed.layout.n_nodes) {
                ++placed.layout.n_nodes;
                placed.positions.push_back(x);
            }
            nodes[k] = node;
        }
    }
    return placed;
}

// Cuboids of square section one behind the other inside the part torus.
PlacedLayout ring_in_torus(int n_sections) {
    PlacedLayout placed;
    placed.layout = test::ring_of_cuboids(n_sections);
    for (int section = 0; section < n_sections; ++section) {
        const double angle = 2.0 * std::numbers::pi * section / n_sections;
        for (int k = 0; k < 4; ++k) {
            const double radius = 60.0 + ((k & 1) != 0 ? 14.0 : -14.0);
            placed.positions.emplace_back(radius * std::cos(angle), radius * std::sin(angle),
                                          (k & 2) != 0 ? -14.0 : 14.0);
        }
    }
    return placed;
}

struct Solid {
    SurfaceMesh mesh;
    Features features;
};

Solid solid_of(const std::string& part) {
    Solid solid{make_surface_mesh(make_part_surface(part).soup), {}};
    solid.features = detect_features(solid.mesh);
    return solid;
}

}  // namespace

TEST_CASE("place_layout: a part's own cuboids lie on its surface and become a certified volume",
          "[layout]") {
    const Solid solid = solid_of("half_seal");
    const PlacedLayout placed = cuboids_of("half_seal");
    REQUIRE(placed.layout.n_cuboids() == 10);
    CuboidDecomposition cuboids = place_layout(solid.mesh, solid.features, placed);
    CHECK(untied_length(cuboids) == 0.0);
    CHECK(find_rounded_edges(cuboids).empty());
    CHECK(cuboids.volume.n_cuboids() == 10);
    const double diagonal = bounding_box_diagonal(solid.mesh);
    // Nodes on no sharp edge lie where embed_layout puts them.
    constexpr double nearby = 0.1;
    for (int n = 0; n < placed.layout.n_nodes; ++n) {
        const VertexHandle vertex = cuboids.surface.nodes[n];
        if (!vertex.is_valid()) continue;
        INFO("node " << n);
        CHECK((cuboids.mesh.point(vertex) - placed.positions[n]).norm() < nearby * diagonal);
    }
    const QuadLayout& layout = cuboids.surface.layout;
    REQUIRE(static_cast<int>(cuboids.arc_lengths.size()) == layout.n_arcs());
    for (int a = 0; a < layout.n_arcs(); ++a) {
        if (cuboids.surface.is_feature_arc[a]) continue;
        const auto [from, to] = layout.arcs()[a];
        CHECK(cuboids.arc_lengths[a] ==
              Approx((placed.positions[from] - placed.positions[to]).norm()));
    }
    for (const int degree : {2, 3}) {
        SolidMeshOptions options;
        options.volume.degree = degree;
        const SolidMesh volume = mesh_solid(cuboids, options);
        CHECK(volume.volume->report.parameterization.validity == iga::Validity::valid);
        CHECK(volume.volume->report.max_distance < 0.001 * diagonal);
    }
}

TEST_CASE("place_layout: a smooth ball and a smooth ring are cut open along arcs", "[layout]") {
    PlacedLayout placed;
    TriangleSoup soup = make_part_surface("cube").soup;
    bool is_ring = false;
    SECTION("ball") {
        const Vector3 centre = Vector3::Constant(50.0);
        for (Vector3& x : soup.points) x = 50.0 * (x - centre).normalized();
        placed.layout.n_nodes = 8;
        placed.layout.cuboids = {{0, 1, 2, 3, 4, 5, 6, 7}};
        for (int k = 0; k < 8; ++k) {
            placed.positions.push_back(30.0 *
                                       Vector3(2 * (k & 1) - 1, (k & 2) - 1, (k & 4) / 2 - 1));
        }
    }
    SECTION("ring") {
        is_ring = true;
        soup = make_part_surface("torus").soup;
        placed = ring_in_torus(6);
    }
    SurfaceMesh mesh = make_surface_mesh(soup);
    const Features features = detect_features(mesh);
    const CuboidDecomposition cuboids = place_layout(mesh, features, placed);
    // One sheet below the whole wall.
    CHECK(cuboids.volume.n_cuboids() == (is_ring ? 6 + 24 : 1 + 6));
    SolidMeshOptions options;
    options.element_size = 15.0;
    const SolidMesh solid = mesh_solid(cuboids, options);
    CHECK(solid.volume->report.parameterization.validity == iga::Validity::valid);
    CHECK(solid.volume->report.quality.min_scaled_jacobian > 0.5);
}

namespace {

// A bar of length 100 along z whose section is a square of side 100 with a corner cut off, and one
// cuboid in it, an edge of which lies along one side of the cut.
struct CutBar {
    SurfaceMesh mesh;
    Features features;
    PlacedLayout placed;
};

CutBar cut_bar() {
    TriangleSoup soup;
    const std::array<Vector3, 5> section = {Vector3(0, 0, 0), Vector3(100, 0, 0),
                                            Vector3(100, 80, 0), Vector3(80, 100, 0),
                                            Vector3(0, 100, 0)};
    for (const Vector3& x : section) soup.points.push_back(x);
    for (const Vector3& x : section) soup.points.push_back(x + Vector3(0, 0, 100));
    for (int k = 1; k < 4; ++k) {
        soup.triangles.push_back({0, k + 1, k});
        soup.triangles.push_back({5, 5 + k, 6 + k});
    }
    for (int k = 0; k < 5; ++k) {
        const int next = (k + 1) % 5;
        soup.triangles.push_back({k, next, 5 + next});
        soup.triangles.push_back({k, 5 + next, 5 + k});
    }
    CutBar bar{make_surface_mesh(soup), {}, {}};
    bar.features = detect_features(bar.mesh);
    bar.placed.layout.n_nodes = 8;
    bar.placed.layout.cuboids = {{0, 1, 2, 3, 4, 5, 6, 7}};
    for (const int z : {0, 100}) {
        for (const auto& [x, y] : {std::pair(0, 0), {100, 0}, {0, 100}, {100, 80}}) {
            bar.placed.positions.emplace_back(x, y, z);
        }
    }
    return bar;
}

}  // namespace

TEST_CASE("place_layout: cuboids are divided where a sharp edge crosses them", "[layout]") {
    const CutBar bar = cut_bar();
    const CuboidDecomposition cuboids = place_layout(bar.mesh, bar.features, bar.placed);
    // Two, and padding at the blunt edges.
    CHECK(cuboids.volume.n_cuboids() == 5);
    CHECK(untied_length(cuboids) == 0.0);
    SolidMeshOptions options;
    options.element_size = 25.0;
    const SolidMesh solid = mesh_solid(cuboids, options);
    CHECK(solid.volume->report.parameterization.validity == iga::Validity::valid);
    // Planes and straight edges.
    CHECK(solid.distance->surface < 1e-9);
}

TEST_CASE("place_layout: an outside layout far from a smooth surface is refused", "[layout]") {
    const Solid torus = solid_of("torus");
    PlacedLayout placed = ring_in_torus(4);
    for (Vector3& x : placed.positions) x.x() += 1000.0;
    CHECK_THROWS_WITH(place_layout(torus.mesh, torus.features, placed),
                      Catch::Contains("lies ") &&
                          Catch::Contains("must lie near the surface, in the same units"));
    PlacedLayout mirrored = ring_in_torus(4);
    for (Vector3& x : mirrored.positions) x.z() = -x.z();
    CHECK_THROWS_WITH(place_layout(torus.mesh, torus.features, mirrored),
                      Catch::Contains("lie inside out; corners must be numbered right-handed"));
}

TEST_CASE("place_layout: refuses layouts of another genus or place", "[layout]") {
    const Solid cube = solid_of("cube");
    CHECK_THROWS_WITH(place_layout(cube.mesh, cube.features, cuboids_of("box")),
                      Catch::Contains("no sharp edge of the surface"));
    const Solid seal = solid_of("seal");
    CHECK_THROWS_WITH(place_layout(seal.mesh, seal.features, cuboids_of("half_seal")),
                      Catch::Contains("Euler characteristic 2, the surface"));
}
