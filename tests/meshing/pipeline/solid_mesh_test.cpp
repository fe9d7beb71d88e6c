#include "meshing/pipeline/solid_mesh.h"

#include <catch2/catch.hpp>

#include "iga/core/error.h"
#include "iga/topology/jacobian_certificate.h"
#include "tests/meshing/layout/cut_parts.h"

using namespace couture;
using namespace couture::meshing;

namespace {

CuboidDecomposition cuboids_of(const Job& job) {
    return decompose_into_cuboids(job.opened, job.features, job.pants, job.caps, some_templates());
}

}  // namespace

TEST_CASE("mesh_solid: parts become certified splines near their surface", "[pipeline]") {
    const std::string name = GENERATE("pant", "half_seal", "seal", "cylinder", "double_t");
    const int degree = GENERATE(2, 3);
    CAPTURE(name, degree);
    const Job job = cut_part(name);
    SolidMeshOptions options;
    options.volume.degree = degree;
    const SolidMesh solid = mesh_solid(cuboids_of(job), options);
    CHECK(solid.map->report.n_flipped == 0);
    const auto& report = solid.volume->report;
    CHECK(report.parameterization.validity == iga::Validity::valid);
    CHECK(report.quality.min_scaled_jacobian > 0.5);
    CHECK(report.quality.mean_scaled_jacobian > 0.9);
    CHECK(solid.distance->surface < 1e-3);
    CHECK(solid.distance->features < 5e-4);
    iga::check(solid.volume->volume, 1e-12);
    const auto n_caps =
        std::ranges::count(job.pants.curves, PantsCurveKind::boundary, &PantsCurve::kind);
    CHECK(static_cast<std::ptrdiff_t>(solid.volume->volume.boundary_sets.size()) == n_caps);
    const auto refined =
        iga::refine<3>(solid.volume->volume, std::nullopt, std::array<int, 3>{8, 8, 8});
    for (const auto& patch : refined.patches) {
        CHECK(iga::certify(patch).validity == iga::Validity::valid);
    }
}

TEST_CASE("mesh_solid: tori that meet become certified splines", "[pipeline]") {
    const SolidMesh solid = mesh_solid(cuboids_of(cut_part("double_torus", {}, 4.0)));
    const auto& report = solid.volume->report;
    CHECK(report.parameterization.validity == iga::Validity::valid);
    CHECK(report.quality.min_scaled_jacobian > 0.2);
    CHECK(report.quality.mean_scaled_jacobian > 0.8);
    CHECK(solid.distance->surface < 1e-3);
    CHECK(solid.distance->features < 5e-4);
    const auto refined =
        iga::refine<3>(solid.volume->volume, std::nullopt, std::array<int, 3>{8, 8, 8});
    for (const auto& patch : refined.patches) {
        CHECK(iga::certify(patch).validity == iga::Validity::valid);
    }
}

TEST_CASE("mesh_solid: the three routes of the map", "[pipeline]") {
    const std::string name = GENERATE("double_t", "half_seal");
    CAPTURE(name);
    const Job job = cut_part(name);
    SolidMeshOptions options;
    options.last = SolidStage::quads;
    options.max_relocations = 0;
    constexpr double hardly = 1e-9;
    options.alignment = hardly;
    const SolidMesh free = mesh_solid(cuboids_of(job), options);
    options.alignment = 10.0;
    const SolidMesh drawn = mesh_solid(cuboids_of(job), options);
    CHECK(drawn.map->report.n_flipped == 0);
    CHECK(drawn.map->report.is_converged);
    CHECK(drawn.map->report.mean_angle_to_directions < free.map->report.mean_angle_to_directions);
    // Nodes did not move: quads are those of the map.
    CHECK(drawn.relocation->energies.size() == 1);
    CHECK(drawn.relocation->largest_move < 1e-9);

    options.alignment = 0.0;
    options.last = SolidStage::map;
    options.route = LayoutMapRoute::quadratic;
    const SolidMesh squares = mesh_solid(cuboids_of(job), options);
    CHECK(squares.map->report.mean_angle_to_directions <
          drawn.map->report.mean_angle_to_directions);
    CHECK(squares.mapped_quads.has_value() == (squares.map->report.n_flipped == 0));
    if (name == "double_t") {
        REQUIRE(squares.map->report.n_flipped > 0);
        options.last = SolidStage::quads;
        CHECK_THROWS_WITH(mesh_solid(cuboids_of(job), options), Catch::Contains("are flipped"));
        options.last = SolidStage::map;
    }
    options.route = LayoutMapRoute::harmonic;
    const SolidMesh harmonic = mesh_solid(cuboids_of(job), options);
    CHECK(harmonic.map->report.n_flipped == 0);
    CHECK(harmonic.map->report.energies.size() == 1);
}

TEST_CASE("mesh_solid: stages end where they are asked to, options are checked", "[pipeline]") {
    const Job job = cut_part("pant");
    SolidMeshOptions options;
    const auto run = [&] { return mesh_solid(cuboids_of(job), options); };
    options.last = SolidStage::layout;
    CHECK_FALSE(run().map);
    options.last = SolidStage::quads;
    const SolidMesh quads = run();
    CHECK(quads.quads);
    CHECK_FALSE(quads.volume);
    CuboidDecomposition cuboids = cuboids_of(job);
    cuboids.record.elements = quads.cuboids.record.elements;
    cuboids.record.elements.pop_back();
    CHECK_THROWS_AS(mesh_solid(cuboids, options), TopologyError);
    options.max_relocations = -1;
    CHECK_THROWS_AS(run(), InputError);
    options.max_relocations = 5;
    options.samples_per_element = 1;
    CHECK_THROWS_AS(run(), InputError);
    options.samples_per_element = 4;
    options.element_size = -1.0;
    CHECK_THROWS_AS(run(), InputError);
}
