#include "meshing/field/expected_singularities.h"

#include <catch2/catch.hpp>

#include <cmath>

#include "meshing/field/trivial_connection.h"
#include "tests/meshing/surface/surface_samples.h"

using namespace couture;
using namespace couture::meshing;

namespace {

// The field that they stand for exists.
void check_admissible(const SurfaceMesh& mesh, const ExpectedSingularities& expected) {
    const DualCycles cycles = make_dual_cycles(mesh);
    FieldTopology topology{.symmetry = 4,
                           .singularities = expected.singularities,
                           .boundary_turns = expected.boundary_turns,
                           .generator_turns = {}};
    topology = with_smooth_generators(mesh, cycles, topology);
    CHECK_NOTHROW(trivial_connection(mesh, cycles, topology));
}

}  // namespace

TEST_CASE("expected singularities: corners of a cube", "[field]") {
    const SurfaceMesh mesh = make_surface_mesh(make_cube(8));
    const ExpectedSingularities expected = expected_singularities(mesh);
    REQUIRE(expected.singularities.size() == 8);
    for (const auto& [vertex, index] : expected.singularities) {
        CHECK(index == 1);
        for (const double x : mesh.point(VertexHandle(vertex))) CHECK((x == 0.0 || x == 1.0));
    }
    CHECK(expected.residual == Approx(0.0).margin(1e-9));
    CHECK(expected.n_missing == 0);
    check_admissible(mesh, expected);
}

TEST_CASE("expected singularities: a sphere spreads eight, a torus and a tube need none",
          "[field]") {
    TriangleSoup soup = make_cube(6);
    for (Vector3& p : soup.points) p = (p - Vector3::Constant(0.5)).normalized();
    const SurfaceMesh sphere = make_surface_mesh(soup);
    const ExpectedSingularities of_sphere = expected_singularities(sphere);
    REQUIRE(of_sphere.singularities.size() == 8);
    for (const Singularity& a : of_sphere.singularities) {
        for (const Singularity& b : of_sphere.singularities) {
            if (a == b) continue;
            const double gap =
                (sphere.point(VertexHandle(a.vertex)) - sphere.point(VertexHandle(b.vertex)))
                    .norm();
            CHECK(gap > 0.6);
        }
    }
    check_admissible(sphere, of_sphere);

    const SurfaceMesh tube = make_surface_mesh(make_tube(16, 8, 1.0, 2.0));
    const ExpectedSingularities of_tube = expected_singularities(tube);
    CHECK(of_tube.singularities.empty());
    CHECK(of_tube.boundary_turns == std::vector<int>{0, 0});
    check_admissible(tube, of_tube);

    const SurfaceMesh square = make_surface_mesh(make_square(6));
    const ExpectedSingularities of_square = expected_singularities(square);
    CHECK(of_square.singularities.empty());
    CHECK(of_square.boundary_turns == std::vector<int>{4});
    check_admissible(square, of_square);
}

TEST_CASE("expected singularities: the index formula holds on any surface", "[field]") {
    const SurfaceMesh torus = make_surface_mesh(make_torus(32, 16, 3.0, 1.0));
    const SurfaceMesh plate = make_surface_mesh(make_plate_with_holes(3, 3));
    for (const SurfaceMesh* mesh : {&torus, &plate}) {
        check_admissible(*mesh, expected_singularities(*mesh));
    }
}
