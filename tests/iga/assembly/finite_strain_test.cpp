#include "iga/assembly/finite_strain.h"

#include <catch2/catch.hpp>
#include <random>

#include "iga/assembly/sparsity.h"
#include "iga/core/error.h"
#include "iga/spline/refine.h"
#include "iga/spline/shapes.h"

using namespace couture;
using namespace couture::iga;

namespace {

/// Of central differences with this step: its square times third derivatives of up to a thousand.
constexpr double step = 1e-5;
constexpr double difference_error = 1e-7;

Problem rubber(Kinematics kinematics, StoredEnergy energy) {
    Problem problem;
    problem.kinematics = kinematics;
    problem.materials.resize(1);
    problem.materials[0].name = "rubber";
    problem.materials[0].hyperelastic = make_hyperelastic(energy, 3.0, 20.0);
    return problem;
}

template <int d>
SpacePtr<d> curved_space(int degree);

template <>
SpacePtr<2> curved_space<2>(int degree) {
    MultiPatch<2> part;
    part.patches = {make_quarter_annulus(1.0, 2.0)};
    return std::make_shared<const Space<2>>(refine<2>(part, degree, std::array<int, 2>{2, 2}));
}

template <>
SpacePtr<3> curved_space<3>(int degree) {
    MultiPatch<3> part;
    part.patches = {make_box<3>(Vector3(1.0, 1.0, 1.0))};
    MultiPatch<3> fine = refine<3>(part, degree, std::array<int, 3>{2, 1, 1});
    MatrixX points = fine.patches[0].control_points();
    points.col(0) += 0.2 * points.col(1).cwiseProduct(points.col(2));
    fine.patches[0] = Patch<3>(fine.patches[0].space(), points);
    return std::make_shared<const Space<3>>(fine);
}

MatrixX random_rows(Eigen::Index rows, Eigen::Index columns, double size) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> entry(-size, size);
    return MatrixX::NullaryExpr(rows, columns, [&]() { return entry(random); });
}

template <int d>
void check_derivatives(Kinematics kinematics, StoredEnergy energy, int degree) {
    const SpacePtr<d> space = curved_space<d>(degree);
    const Problem problem = rubber(kinematics, energy);
    FiniteStrain<d> body(space, problem);
    const MatrixX u = random_rows(space->n_dofs(), d, 0.05);
    const MatrixX v = random_rows(space->n_dofs(), d, 1.0).rowwise().reverse();
    REQUIRE(body.deform(u).det_F > 0.2);
    const MatrixX forces = body.internal_forces();
    BlockMatrix K = make_pattern(*space, d);
    body.tangent(K);
    const VectorX Kv = K * MatrixX(v.transpose().reshaped());

    body.deform(u + step * v);
    const double energy_up = body.energy();
    const MatrixX up = body.internal_forces();
    body.deform(u - step * v);
    const double energy_down = body.energy();
    const MatrixX down = body.internal_forces();
    const double scale = Kv.cwiseAbs().maxCoeff();
    CHECK(std::abs((energy_up - energy_down) / (2 * step) - forces.cwiseProduct(v).sum()) <
          difference_error * scale * static_cast<double>(v.size()));
    const VectorX slope = ((up - down) / (2 * step)).transpose().reshaped();
    CHECK((slope - Kv).cwiseAbs().maxCoeff() < difference_error * scale);
}

}  // namespace

TEMPLATE_TEST_CASE_SIG(
    "FiniteStrain: forces are the derivative of the energy, the tangent that of "
    "the forces",
    "[assembly]", ((int degree), degree), 2, 3) {
    for (const StoredEnergy energy :
         {StoredEnergy::neo_hookean, StoredEnergy::neo_hookean_logarithmic,
          StoredEnergy::saint_venant_kirchhoff}) {
        check_derivatives<3>(Kinematics::solid, energy, degree);
        check_derivatives<2>(Kinematics::plane_strain, energy, degree);
        check_derivatives<2>(Kinematics::axisymmetric, energy, degree);
    }
}

TEST_CASE("FiniteStrain: a rigid rotation needs no forces", "[assembly]") {
    const SpacePtr<3> space = curved_space<3>(2);
    const Problem problem = rubber(Kinematics::solid, StoredEnergy::neo_hookean);
    FiniteStrain<3> body(space, problem);
    const MatrixX& points = space->geometry().patches[0].control_points();
    MatrixX u = -points;
    u.col(0) += points.col(1);
    u.col(1) -= points.col(0);
    u.col(2) += points.col(2);
    CHECK(body.deform(u).det_F == Approx(1.0).epsilon(1e-13));
    CHECK(body.internal_forces().cwiseAbs().maxCoeff() < 1e-13);
    CHECK(std::abs(body.energy()) < 1e-14);
}

TEST_CASE("FiniteStrain: the most compressed point is found", "[assembly]") {
    const SpacePtr<3> space = curved_space<3>(2);
    const Problem problem = rubber(Kinematics::solid, StoredEnergy::neo_hookean);
    FiniteStrain<3> body(space, problem);
    MatrixX u = MatrixX::Zero(space->n_dofs(), 3);
    u.col(2) = -1.5 * space->geometry().patches[0].control_points().col(2);
    const SmallestVolume<3> smallest = body.deform(u);
    CHECK(smallest.det_F == Approx(-0.5).epsilon(1e-12));
    CHECK(smallest.patch == 0);
}

TEST_CASE("FiniteStrain: what it can't take is named", "[assembly]") {
    const SpacePtr<2> space = curved_space<2>(2);
    Problem problem = rubber(Kinematics::plane_stress, StoredEnergy::neo_hookean);
    CHECK_THROWS_WITH(FiniteStrain<2>(space, problem),
                      Catch::Matchers::Contains("'plane_stress' holds for linear elasticity only"));
    problem.kinematics = Kinematics::plane_strain;
    problem.materials[0].hyperelastic.reset();
    CHECK_THROWS_WITH(FiniteStrain<2>(space, problem),
                      "[material.rubber] of patch 0 is linear elastic, others are hyperelastic; at "
                      "finite strain every material needs a hyperelastic 'model'");
}
