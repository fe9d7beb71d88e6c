// Cross fields of layouts that are chosen and drawn on parts, and of the parts without them.
#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>
#include <numeric>

#include "meshing/field/expected_singularities.h"
#include "meshing/field/layout_field.h"
#include "meshing/field/trivial_connection.h"
#include "meshing/layout/cuboid_decomposition.h"
#include "tests/meshing/layout/cut_parts.h"

using namespace couture;
using namespace couture::meshing;

namespace {

constexpr double quarter = 0.5 * std::numbers::pi;
constexpr double rounding = 1e-9;

Job cut(const std::string& name) {
    return cut_part(name, name == "wheel" ? wheel_loops() : std::vector<GuideLoop>{});
}

int sum_of_indices(const FieldTopology& topology) {
    return std::accumulate(
        topology.singularities.begin(), topology.singularities.end(), 0,
        [](int sum, const Singularity& singularity) { return sum + singularity.index; });
}

// Numbers that can be chosen, counted: indices but one (their sum is given), boundaries, two for
// each handle.
void check_freedom(const SurfaceMesh& mesh, const FieldTopology& topology) {
    const SurfaceInvariants invariants = compute_invariants(mesh);
    CHECK(static_cast<int>(topology.generator_turns.size()) == 2 * invariants.genus);
    CHECK(static_cast<int>(topology.boundary_turns.size()) == invariants.n_boundaries);
    const auto n_singularities = static_cast<int>(topology.singularities.size());
    const auto n_all =
        static_cast<int>(topology.generator_turns.size() + topology.boundary_turns.size()) +
        n_singularities;
    const bool is_index_formula_empty = n_singularities + invariants.n_boundaries == 0;
    CHECK(topological_freedom(invariants, n_singularities) ==
          n_all - (is_index_formula_empty ? 0 : 1));
}

}  // namespace

TEST_CASE("field of parts: indices and turns are those of the layout", "[field]") {
    const std::string name = GENERATE("pant", "seal", "double_t", "wheel");
    CAPTURE(name);
    const Job job = cut(name);
    const CuboidDecomposition cuboids =
        decompose_into_cuboids(job.opened, job.features, job.pants, job.caps, some_templates());
    const SurfaceMesh& mesh = cuboids.mesh;
    const LayoutField field = make_layout_field(mesh, cuboids.surface);
    check_freedom(mesh, field.topology);
    const int chi = compute_invariants(mesh).euler_characteristic;
    CHECK(sum_of_indices(field.topology) == 4 * chi);
    CHECK(field.report.feature_angle < rounding);

    // Read off the field: around each vertex it turns by a quarter for each arc that ends there,
    // four times where none does.
    const DualCycles cycles = make_dual_cycles(mesh);
    const Connection curvature = field_curvature(mesh, field.field);
    std::vector<int> expected(mesh.n_vertices(), 4);
    const std::vector<int> valences = cuboids.surface.layout.valences();
    int n_irregular = 0;
    for (std::size_t n = 0; n < valences.size(); ++n) {
        if (!cuboids.surface.nodes[n].is_valid()) continue;
        expected[cuboids.surface.nodes[n].idx()] = valences[n];
        n_irregular += valences[n] != 4 ? 1 : 0;
    }
    CHECK(static_cast<int>(field.topology.singularities.size()) == n_irregular);
    double largest = 0.0;
    for (std::size_t v = 0; v < cycles.inner_vertices.size(); ++v) {
        const double turns = turns_against(mesh, cycles.around_vertices[v], curvature) / quarter;
        largest = std::max(largest, std::abs(turns - expected[cycles.inner_vertices[v].idx()]));
    }
    CHECK(largest < rounding);
    for (std::size_t g = 0; g < cycles.generators.size(); ++g) {
        const double turns = turns_against(mesh, cycles.generators[g], curvature) / quarter;
        CHECK(turns == Approx(field.topology.generator_turns[g]).margin(rounding));
    }
}

TEST_CASE("field of parts: first axes of charts run along arcs", "[field]") {
    const std::string name = GENERATE("seal", "double_t");
    const Job job = cut(name);
    const CuboidDecomposition cuboids =
        decompose_into_cuboids(job.opened, job.features, job.pants, job.caps, some_templates());
    const SurfaceMesh& mesh = cuboids.mesh;
    const LayoutField field = make_layout_field(mesh, cuboids.surface);
    const std::vector<double> axes = chart_directions(mesh, cuboids.surface, field.field);
    const FaceFrames frames(mesh);
    int n_sharp = 0;
    for (int a = 0; a < cuboids.surface.layout.n_arcs(); ++a) {
        if (!cuboids.surface.is_feature_arc[a]) continue;
        const auto& path = cuboids.surface.arcs[a];
        const auto& [left, right] = cuboids.surface.layout.arc_quads(a);
        for (std::size_t i = 0; i + 1 < path.size(); ++i) {
            const HalfedgeHandle h = mesh.find_halfedge(path[i], path[i + 1]);
            const HalfedgeHandle back = mesh.opposite_halfedge_handle(h);
            const double on_left =
                frames.angle(h) - axes[mesh.face_handle(h).idx()] - quarter * left.side;
            const double on_right =
                frames.angle(back) - axes[mesh.face_handle(back).idx()] - quarter * right.side;
            CHECK(std::abs(std::remainder(on_left, 4.0 * quarter)) < rounding);
            CHECK(std::abs(std::remainder(on_right, 4.0 * quarter)) < rounding);
            ++n_sharp;
        }
    }
    CHECK(n_sharp > 0);
}

TEST_CASE("field of parts: without a layout, opened and closed", "[field]") {
    const std::string name = GENERATE("pant", "seal", "double_t", "wheel");
    const bool is_open = GENERATE(true, false);
    CAPTURE(name, is_open);
    SurfaceMesh closed = make_surface_mesh(make_part_surface(name).soup);
    static_cast<void>(detect_features(closed));
    const SurfaceMesh mesh = is_open ? cut(name).opened : closed;
    const ExpectedSingularities expected = expected_singularities(mesh);
    const DualCycles cycles = make_dual_cycles(mesh);
    const FieldTopology topology =
        with_smooth_generators(mesh, cycles,
                               {.symmetry = 4,
                                .singularities = expected.singularities,
                                .boundary_turns = expected.boundary_turns,
                                .generator_turns = {}});
    check_freedom(mesh, topology);
    const int n_boundary_turns =
        std::accumulate(topology.boundary_turns.begin(), topology.boundary_turns.end(), 0);
    CHECK(sum_of_indices(topology) + n_boundary_turns ==
          4 * compute_invariants(mesh).euler_characteristic);
    const DirectionField field = integrate_connection(
        mesh, trivial_connection(mesh, cycles, topology), 4, 0.0, make_dual_tree(mesh));
    CHECK(topology_of(mesh, cycles, field) == topology);
}
