#include "meshing/field/trivial_connection.h"

#include <catch2/catch.hpp>

#include <Eigen/QR>
#include <cmath>
#include <numbers>

#include "iga/core/error.h"
#include "meshing/surface/curvature.h"
#include "tests/meshing/surface/surface_samples.h"

using namespace couture;
using namespace couture::meshing;

namespace {

constexpr double pi = std::numbers::pi;
constexpr double rounding = 1e-9;

// Every equation, the dropped one too.
void check_holonomy(const SurfaceMesh& mesh, const DualCycles& cycles,
                    const FieldTopology& topology, const Connection& x) {
    const double turn = 2.0 * pi / topology.symmetry;
    std::vector<int> index(mesh.n_vertices(), 0);
    for (const Singularity& s : topology.singularities) index[s.vertex] = s.index;
    double largest = 0.0;
    const auto compare = [&](const DualCycle& cycle, int turns) {
        largest = std::max(largest, std::abs(turns_against(mesh, cycle, x) - turn * turns));
    };
    for (std::size_t k = 0; k < cycles.inner_vertices.size(); ++k) {
        compare(cycles.around_vertices[k],
                topology.symmetry - index[cycles.inner_vertices[k].idx()]);
    }
    for (std::size_t k = 0; k < cycles.along_boundaries.size(); ++k) {
        compare(cycles.along_boundaries[k], topology.boundary_turns[k]);
    }
    for (std::size_t k = 0; k < cycles.generators.size(); ++k) {
        compare(cycles.generators[k], topology.generator_turns[k]);
    }
    CHECK(largest < rounding);
}

SurfaceMesh some_surface(const std::string& name) {
    if (name == "cube") return make_surface_mesh(make_cube(4));
    if (name == "torus") return make_surface_mesh(make_torus(24, 12, 3.0, 1.0));
    if (name == "tube") return make_surface_mesh(make_tube(12, 6, 1.0, 3.0));
    if (name == "square") return make_surface_mesh(make_square(4));
    if (name == "two") {
        return make_surface_mesh(join(make_plate_with_holes(2, 2), make_tube(8, 3, 1.0, 1.0)));
    }
    return make_surface_mesh(make_plate_with_holes(3, 2));
}

}  // namespace

TEST_CASE("dual cycles: two generators for each handle, and their curvature", "[field]") {
    const auto name = GENERATE("cube", "torus", "tube", "square", "plate", "two");
    CAPTURE(name);
    const SurfaceMesh mesh = some_surface(name);
    const DualCycles cycles = make_dual_cycles(mesh);
    const SurfaceInvariants invariants = compute_invariants(mesh);
    CHECK(static_cast<int>(cycles.generators.size()) == 2 * invariants.genus);
    CHECK(static_cast<int>(cycles.along_boundaries.size()) == invariants.n_boundaries);
    for (const DualCycle& cycle : cycles.generators) {
        for (std::size_t k = 0; k < cycle.crossed.size(); ++k) {
            const auto into = mesh.face_handle(mesh.opposite_halfedge_handle(cycle.crossed[k]));
            CHECK(into == mesh.face_handle(cycle.crossed[(k + 1) % cycle.crossed.size()]));
        }
    }
    // Curvature of all that lies between cycles: Gauss and Bonnet.
    double sum = 0.0;
    for (const DualCycle& cycle : cycles.around_vertices) sum += 2.0 * pi - cycle.curvature;
    for (const DualCycle& cycle : cycles.along_boundaries) sum += cycle.curvature;
    CHECK(sum == Approx(2.0 * pi * invariants.euler_characteristic).margin(rounding));
}

TEST_CASE("dual cycles: one relation in each component", "[field]") {
    const auto name = GENERATE("cube", "torus", "tube", "square");
    CAPTURE(name);
    const SurfaceMesh mesh = some_surface(name);
    const DualCycles cycles = make_dual_cycles(mesh);
    std::vector<DualCycle> all = cycles.around_vertices;
    all.insert(all.end(), cycles.along_boundaries.begin(), cycles.along_boundaries.end());
    all.insert(all.end(), cycles.generators.begin(), cycles.generators.end());
    MatrixX A = MatrixX::Zero(static_cast<Eigen::Index>(all.size()),
                              static_cast<Eigen::Index>(mesh.n_edges()));
    for (std::size_t row = 0; row < all.size(); ++row) {
        for (const HalfedgeHandle h : all[row].crossed) {
            const EdgeHandle edge = mesh.edge_handle(h);
            A(static_cast<Eigen::Index>(row), edge.idx()) +=
                mesh.halfedge_handle(edge, 0) == h ? 1.0 : -1.0;
        }
    }
    CHECK(Eigen::ColPivHouseholderQR<MatrixX>(A).rank() == A.rows() - 1);
}

TEST_CASE("trivial connection: holonomy around every vertex and loop", "[field]") {
    const auto symmetry = GENERATE(1, 2, 4, 6);
    CAPTURE(symmetry);
    SECTION("sphere") {
        const SurfaceMesh mesh = some_surface("cube");
        const DualCycles cycles = make_dual_cycles(mesh);
        const FieldTopology topology{symmetry, {{3, 2 * symmetry + 1}, {17, -1}}, {}, {}};
        check_holonomy(mesh, cycles, topology, trivial_connection(mesh, cycles, topology));
    }
    SECTION("genus 3") {
        const SurfaceMesh mesh = some_surface("plate");
        const DualCycles cycles = make_dual_cycles(mesh);
        const FieldTopology topology{
            symmetry, {{3, -3 * symmetry}, {17, -symmetry}}, {}, {0, 1, -1, 2, 5, 0}};
        check_holonomy(mesh, cycles, topology, trivial_connection(mesh, cycles, topology));
    }
    SECTION("two components, one with boundaries") {
        const SurfaceMesh mesh = some_surface("two");
        const DualCycles cycles = make_dual_cycles(mesh);
        const FieldTopology topology{symmetry, {{3, -2 * symmetry}}, {2, -2}, {0, 0, 1, 0}};
        check_holonomy(mesh, cycles, topology, trivial_connection(mesh, cycles, topology));
    }
}

TEST_CASE("trivial connection: smooth generators leave a torus without turns", "[field]") {
    const SurfaceMesh mesh = some_surface("torus");
    const DualCycles cycles = make_dual_cycles(mesh);
    const FieldTopology smooth = with_smooth_generators(mesh, cycles, {4, {}, {}, {0, 0}});
    const auto energy = [&](const FieldTopology& topology) {
        double sum = 0.0;
        for (const double x : trivial_connection(mesh, cycles, topology).angles()) sum += x * x;
        return sum;
    };
    FieldTopology other = smooth;
    for (int k = 0; k < 2; ++k) {
        for (const int change : {-1, 1}) {
            other.generator_turns[k] = smooth.generator_turns[k] + change;
            CHECK(energy(other) > energy(smooth));
        }
        other.generator_turns[k] = smooth.generator_turns[k];
    }
}

TEST_CASE("field topology: freedom and the index formula", "[field]") {
    const SurfaceMesh torus = some_surface("torus");
    CHECK(topological_freedom(compute_invariants(torus), 0) == 2);
    CHECK(topological_freedom(compute_invariants(torus), 2) == 3);
    CHECK(topological_freedom(compute_invariants(some_surface("tube")), 0) == 1);
    CHECK(topological_freedom(compute_invariants(some_surface("plate")), 3) == 8);
    const SurfaceMesh cube = some_surface("cube");
    const DualCycles cycles = make_dual_cycles(cube);
    CHECK_NOTHROW(check_topology(cube, cycles, {4, {{0, 8}}, {}, {}}));
    CHECK_THROWS_WITH(check_topology(cube, cycles, {4, {{0, 7}}, {}, {}}),
                      Catch::Contains("sum to 7") && Catch::Contains("must be 8"));
    CHECK_THROWS_WITH(check_topology(cube, cycles, {3, {{0, 6}}, {}, {}}),
                      Catch::Contains("1, 2, 4 or 6"));
    CHECK_THROWS_WITH(check_topology(cube, cycles, {4, {{0, 4}, {0, 4}}, {}, {}}),
                      Catch::Contains("vertex 0"));
    CHECK_THROWS_WITH(check_topology(cube, cycles, {4, {{0, 8}}, {1}, {}}),
                      Catch::Contains("1 turns for 0 boundaries"));
}
