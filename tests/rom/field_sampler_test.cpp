#include "rom/field_sampler.h"

#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <cmath>

#include "iga/core/error.h"
#include "iga/core/parallel.h"
#include "iga/post/stress.h"
#include "tests/rom/box_family.h"

using namespace couture;
using namespace couture::rom;
using Catch::Contains;
using couture::tests::BoxFamily;

namespace {

/// Relative to the largest value: rounding of sums in another order.
constexpr double rounding = 1e-11;

/// A smooth displacement that is not small in its derivatives.
VectorX wavy_field(const iga::Space<3>& space, double size) {
    const VectorX x = to_field(space, space.geometry());
    VectorX u(x.size());
    for (Eigen::Index i = 0; i < x.size(); ++i) {
        u[i] = size * std::sin(0.37 * static_cast<double>(i) + 0.1 * x[i]);
    }
    return u;
}

/// A quarter of a ring, rational, extruded.
iga::SpacePtr<3> ring() {
    iga::MultiPatch<3> part;
    part.patches = {
        iga::make_extrusion(iga::make_quarter_annulus(1.0, 2.0), Vector3(0.0, 0.0, 1.5))};
    return std::make_shared<const iga::Space<3>>(
        iga::refine<3>(part, 3, std::array<int, 3>{2, 3, 1}));
}

iga::SpacePtr<3> boxes(int degree, int n_elements) {
    return std::make_shared<const iga::Space<3>>(
        BoxFamily::geometry(BoxFamily::point({0.3, 0.8, 0.5, 0.5, 0.5, 0.5}), degree, n_elements));
}

iga::Problem steel() {
    iga::Problem problem;
    problem.materials = {iga::make_isotropic("steel", 200.0, 0.3)};
    return problem;
}

/// Compares with one point after the other.
void compare(const iga::SpacePtr<3>& space, const FieldSampler& sampler,
             const iga::Problem& problem) {
    const VectorX u = wavy_field(*space, 0.1);
    const FieldSamples samples = sampler.sample(to_field(*space, space->geometry()), u, problem);
    const iga::Field<3> field{space, iga::unflatten(u, 3)};
    const double scale = samples.stresses.cwiseAbs().maxCoeff();
    int i = 0;
    for (const SampleGrid& grid : sampler.grids()) {
        for (int k = 0; k < grid.n_points(); ++k, ++i) {
            const Vector3 xi = grid.point(k);
            const Vector<6> stress = iga::stress_at<3>(problem, field, "", grid.patch, xi).stress;
            CHECK((samples.stresses.col(i) - stress).norm() < rounding * scale);
            CHECK(std::abs(samples.von_mises[i] - iga::von_mises(stress)) < rounding * scale);
            CHECK((samples.points.col(i) - space->geometry().patches[grid.patch].point(xi)).norm() <
                  rounding);
            CHECK((samples.displacements.col(i) - field.value(grid.patch, xi)).norm() < rounding);
        }
    }
    REQUIRE(i == sampler.n_points());
}

}  // namespace

TEST_CASE("make_sample_grids: points at the ends of elements and between them", "[rom]") {
    const iga::SpacePtr<3> space = boxes(2, 3);
    const auto volume = make_sample_grids(*space, SampleRegion::volume, 2);
    REQUIRE(volume.size() == 2);
    CHECK(volume[1].sizes() == std::array<int, 3>{7, 7, 7});
    CHECK((volume[0].point(7 * 7 + 7 * 2 + 1) - Vector3(1.0, 2.0, 1.0) / 6.0).norm() < 1e-14);
    const auto sides = make_sample_grids(*space, SampleRegion::outer_sides);
    REQUIRE(sides.size() == 10);
    for (const SampleGrid& side : sides) {
        CHECK(side.n_points() == 16);
    }
    CHECK_THROWS_WITH(make_sample_grids(*space, SampleRegion::volume, 0),
                      Contains("0 cells per element"));
}

TEST_CASE("FieldSampler: stresses are those of stress_at", "[rom]") {
    const iga::SpacePtr<3> space = GENERATE(boxes(1, 3), boxes(2, 2), boxes(3, 5), ring());
    const auto region = GENERATE(SampleRegion::volume, SampleRegion::outer_sides);
    const FieldSampler sampler(space, make_sample_grids(*space, region, 2));
    compare(space, sampler, steel());
}

TEST_CASE("FieldSampler: any stiffness, another on each patch, any points", "[rom]") {
    const iga::SpacePtr<3> space = boxes(2, 3);
    iga::Problem problem = steel();
    problem.materials[0].patches = {1};
    iga::Material wood;
    wood.name = "wood";
    wood.patches = {0};
    wood.stiffness =
        iga::orthotropic_stiffness({{12.0, 0.8, 0.5}, {0.3, 0.02, 0.03}, {0.2, 0.7, 0.9}});
    problem.materials.push_back(wood);
    const std::vector<SampleGrid> grids = {
        {1, {{{0.1, 0.2, 0.9}, {0.5}, {0.0, 0.4, 0.45, 0.5, 1.0}}}}, {0, {{{0.3}, {0.7}, {0.99}}}}};
    compare(space, FieldSampler(space, grids), problem);
}

TEST_CASE("FieldSampler: thermal strains are taken off", "[rom]") {
    const iga::SpacePtr<3> space = boxes(2, 2);
    iga::Problem problem = steel();
    problem.materials[0].thermal_expansion = Vector3(1e-3, 2e-3, 3e-3);
    iga::Temperature temperature;
    temperature.change = [](const Vector3& x, double) { return x[0] - 2.0 * x[2]; };
    problem.temperatures = {temperature};
    compare(space, FieldSampler(space, make_sample_grids(*space, SampleRegion::volume)), problem);
}

TEST_CASE("FieldSampler: hyperelastic stresses are those of the deformation gradient", "[rom]") {
    const iga::SpacePtr<3> space = boxes(2, 2);
    iga::Problem problem = steel();
    problem.materials[0].hyperelastic =
        iga::make_hyperelastic(iga::StoredEnergy::neo_hookean, 2.0, 20.0);
    const FieldSampler sampler(space, make_sample_grids(*space, SampleRegion::volume));
    const VectorX u = wavy_field(*space, 0.3);
    const FieldSamples samples = sampler.sample(to_field(*space, space->geometry()), u, problem);
    const iga::Field<3> field{space, iga::unflatten(u, 3)};
    for (int i = 0; i < sampler.grids()[0].n_points(); ++i) {
        const Matrix<3> H = field.gradient(0, sampler.grids()[0].point(i));
        REQUIRE((Matrix<3>::Identity() + H).determinant() > 0.0);
        const Matrix<3> stress =
            iga::cauchy_stress(iga::piola_stress(*problem.materials[0].hyperelastic, H), H);
        CHECK((iga::to_tensor(samples.stresses.col(i)) - stress).norm() < rounding);
    }
}

TEST_CASE("FieldSampler: there are stresses beside collapsed sides", "[rom]") {
    // A wedge: one side of the box is a line.
    MatrixX corners = iga::make_box<3>(Vector3(1.0, 1.0, 1.0)).control_points();
    for (Eigen::Index i = 0; i < 8; i += 2) {
        corners(i, 1) = 0.0;
    }
    iga::MultiPatch<3> part;
    part.patches = {iga::make_multilinear<3>(corners)};
    const auto space =
        std::make_shared<const iga::Space<3>>(iga::refine<3>(part, 2, std::array<int, 3>{2, 2, 2}));
    const FieldSampler sampler(space, make_sample_grids(*space, SampleRegion::volume));
    // u = (0, 0, z): uniaxial strain.
    VectorX u = to_field(*space, space->geometry());
    for (Eigen::Index i = 0; i < u.size(); i += 3) {
        u.segment<2>(i).setZero();
    }
    const FieldSamples samples = sampler.sample(to_field(*space, space->geometry()), u, steel());
    REQUIRE(samples.stresses.allFinite());
    const double expected = 2.0 * 200.0 / 2.6;
    CHECK((samples.von_mises.array() / expected - 1.0).abs().maxCoeff() < 1e-8);
}

TEST_CASE("FieldSampler: the same for any number of threads", "[rom]") {
    const iga::SpacePtr<3> space = boxes(3, 4);
    const FieldSampler sampler(space, make_sample_grids(*space, SampleRegion::outer_sides, 3));
    const VectorX x = to_field(*space, space->geometry());
    const VectorX u = wavy_field(*space, 0.1);
    const int before = n_threads();
    set_n_threads(1);
    const FieldSamples one = sampler.sample(x, u, steel());
    set_n_threads(3);
    const FieldSamples three = sampler.sample(x, u, steel());
    set_n_threads(before);
    CHECK(one.stresses == three.stresses);
    CHECK(one.von_mises == three.von_mises);
}

TEST_CASE("FieldSampler: refuses what does not fit", "[rom]") {
    const iga::SpacePtr<3> space = boxes(2, 2);
    CHECK_THROWS_WITH(FieldSampler(space, {{2, {{{0.5}, {0.5}, {0.5}}}}}),
                      Contains("a grid of patch 2; there are 2"));
    CHECK_THROWS_WITH(FieldSampler(space, {{1, {{{0.5}, {0.5, 1.5}, {0.5}}}}}),
                      Contains("patch 1 direction 1: 2 parameters from 0.5 to 1.5"));
    const FieldSampler sampler(space, make_sample_grids(*space, SampleRegion::volume));
    const VectorX x = to_field(*space, space->geometry());
    CHECK_THROWS_WITH(sampler.sample(x, x.head(3), steel()), Contains("3 for the displacement"));
    iga::Problem poisson = steel();
    poisson.physics = iga::Physics::poisson;
    CHECK_THROWS_WITH(sampler.sample(x, x, poisson), Contains("no elastic solid"));
}
