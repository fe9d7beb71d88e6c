#include "meshing/field/layout_field.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "iga/core/error.h"
#include "meshing/field/aligned_field.h"
#include "meshing/field/layout_topology.h"
#include "tests/meshing/parameterization/layout_surfaces.h"
#include "tests/meshing/surface/surface_samples.h"

using namespace couture;
using namespace couture::meshing;

namespace {

constexpr double rounding = 1e-9;

const auto same = [](const Vector3& p) { return p; };
const auto all = [](const auto&) { return true; };

// The fields have the layout's topology, whose equations hold: nothing on the way was rounded.
LayoutField check_field(const LaidOutSurface& surface, const LayoutFieldOptions& options = {}) {
    const auto& [mesh, embedding] = surface;
    const DualCycles cycles = make_dual_cycles(mesh);
    const FieldTopology topology = topology_of_layout(mesh, embedding, cycles);
    check_topology(mesh, cycles, topology);
    LayoutField field = make_layout_field(mesh, embedding, options);
    CHECK(field.topology == topology);
    CHECK(topology_of(mesh, cycles, field.field) == topology);
    return field;
}

// Largest angle between the cross and an edge of an arc.
double angle_to_arcs(const LaidOutSurface& surface, const DirectionField& field) {
    const FaceFrames frames(surface.mesh);
    double largest = 0.0;
    for (const auto& path : surface.embedding.arcs) {
        for (std::size_t i = 0; i + 1 < path.size(); ++i) {
            HalfedgeHandle h = surface.mesh.find_halfedge(path[i], path[i + 1]);
            for (int side = 0; side < 2; ++side, h = surface.mesh.opposite_halfedge_handle(h)) {
                if (surface.mesh.is_boundary(h)) continue;
                const FaceHandle face = surface.mesh.face_handle(h);
                largest = std::max(largest, std::abs(nearest_offset(field, face, frames.angle(h))));
            }
        }
    }
    return largest;
}

// A plate with holes; the unit squares of its cubes are the quads.
LaidOutSurface make_plate_layout(int genus, int n) {
    const TriangleSoup soup = make_plate_with_holes(genus, n);
    const TriangleSoup coarse = make_plate_with_holes(genus, 1);
    std::vector<int> vertices;
    for (const Vector3& node : coarse.points) {
        const auto at = std::ranges::find_if(
            soup.points, [&](const Vector3& p) { return (p - node).norm() < rounding; });
        vertices.push_back(static_cast<int>(at - soup.points.begin()));
    }
    // The two triangles of a square meet along its diagonal.
    std::vector<std::array<int, 4>> quads;
    const SurfaceMesh mesh = make_surface_mesh(coarse);
    for (const EdgeHandle edge : mesh.edges()) {
        if (edge_length(mesh, edge) < 1.2) continue;
        const HalfedgeHandle h = mesh.halfedge_handle(edge, 0);
        const HalfedgeHandle opposite = mesh.opposite_halfedge_handle(h);
        quads.push_back({mesh.from_vertex_handle(h).idx(),
                         mesh.to_vertex_handle(mesh.next_halfedge_handle(opposite)).idx(),
                         mesh.to_vertex_handle(h).idx(),
                         mesh.to_vertex_handle(mesh.next_halfedge_handle(h)).idx()});
    }
    return lay_out(soup, quads, vertices, all);
}

}  // namespace

TEST_CASE("layout field: a cube's corners are singular and its edges are followed", "[field]") {
    const LaidOutSurface cube = make_cube_layout(4, same, all);
    const LayoutField field = check_field(cube, {.principal_strength = 0.0});
    REQUIRE(field.topology.singularities.size() == 8);
    for (const Singularity& s : field.topology.singularities) CHECK(s.index == 1);
    CHECK(angle_to_arcs(cube, field.field) < rounding);
    // The cube is its own cross field.
    CHECK(field.report.energy < rounding);
}

TEST_CASE("layout field: sphere with eight nodes of valence 3", "[field]") {
    const LaidOutSurface sphere = make_sphere_layout(6, Vector3(0.1, 0.05, 0.0));
    const LayoutField field = check_field(sphere);
    CHECK(field.topology.singularities.size() == 8);
    CHECK(angle_to_arcs(sphere, field.field) < 0.7);
    CHECK(field.report.energy >= field.report.topological_energy - rounding);
}

TEST_CASE("layout field: a torus keeps its layout's winding", "[field]") {
    const LaidOutSurface straight = make_torus_layout(6, {0, 16, 32}, {0, 0, 0});
    const LayoutField field = check_field(straight);
    CHECK(field.topology.singularities.empty());
    CHECK(field.topology.generator_turns == std::vector<int>{0, 0});
    CHECK(angle_to_arcs(straight, field.field) < 0.5);
}

TEST_CASE("layout field: boundaries of a tube are followed exactly", "[field]") {
    const bool is_zigzag = GENERATE(false, true);
    const LaidOutSurface tube = make_tube_layout(8, is_zigzag);
    const LayoutField field = check_field(tube);
    CHECK(field.topology.boundary_turns == std::vector<int>{0, 0});
    CHECK(field.report.feature_angle < rounding);
    // Whatever way the arcs take inside, the field is that of the cylinder.
    CHECK(field.report.energy < rounding);
}

TEST_CASE("layout field: offsets of arcs fix the same quarter turn everywhere", "[field]") {
    // The turned can: arcs of the wall are slanted, so that nearest quarters alone may go wrong.
    const LaidOutSurface can = make_can_layout(6, 0.6);
    const LayoutField field = check_field(can);
    CHECK(field.report.feature_angle < rounding);
    CHECK(field.topology.singularities.size() == 8);
}

TEST_CASE("layout field: plates with holes are their own cross fields", "[field]") {
    const int genus = GENERATE(1, 2, 3);
    CAPTURE(genus);
    const LaidOutSurface plate = make_plate_layout(genus, 3);
    const LayoutField field = check_field(plate, {.principal_strength = 0.0});
    CHECK(static_cast<int>(field.topology.generator_turns.size()) == 2 * genus);
    CHECK(angle_to_arcs(plate, field.field) < rounding);
    // With one wrong turn along a generator there is no flat field.
    CHECK(field.report.energy < rounding);
}

TEST_CASE("layout field: an arc off the mesh is an error", "[field]") {
    LaidOutSurface cube = make_cube_layout(4, same, all);
    std::swap(cube.embedding.arcs[0][1], cube.embedding.arcs[1][1]);
    CHECK_THROWS_WITH(make_layout_field(cube.mesh, cube.embedding), Catch::Contains("arc 0"));
}
