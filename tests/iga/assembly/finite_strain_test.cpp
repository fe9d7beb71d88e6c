#include "iga/assembly/finite_strain.h"

#include <Eigen/Cholesky>
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

/// A body whose reference is deformed: F_b is no gradient of U_b, as after a projection.
template <int d>
ReferencePtr<d> deformed_reference(const SpacePtr<d>& space) {
    ReferenceConfiguration<d> reference{space, random_rows(space->n_dofs(), d, 0.03),
                                        random_rows(space->n_dofs(), 9, 0.1)};
    if (d == 2) {
        for (const int out_of_plane : {2, 5, 6, 7}) {
            reference.gradient.col(out_of_plane).setZero();
        }
    }
    return std::make_shared<const ReferenceConfiguration<d>>(std::move(reference));
}

/// Tangent times a column, with what the projection adds.
template <int d>
VectorX tangent_times(const FiniteStrain<d>& body, const Space<d>& space, const MatrixX& v) {
    BlockMatrix K = make_pattern(space, d);
    body.tangent(K);
    const VectorX column = v.transpose().reshaped();
    VectorX result = K * MatrixX(column);
    if (const auto coupling = body.coupling()) {
        const VectorX strain = coupling->B.transpose() * column;
        result += coupling->B * MatrixX(coupling->compliance).ldlt().solve(strain);
    }
    return result;
}

template <int d>
void check_derivatives(const ReferencePtr<d>& reference, Kinematics kinematics, StoredEnergy energy,
                       Volumetric volumetric) {
    const Space<d>& space = *reference->space;
    const Problem problem = rubber(kinematics, energy);
    FiniteStrain<d> body(reference, problem, {}, volumetric);
    const MatrixX u = random_rows(space.n_dofs(), d, 0.05);
    const MatrixX v = random_rows(space.n_dofs(), d, 1.0).rowwise().reverse();
    REQUIRE(body.deform(u).det_F > 0.2);
    const MatrixX forces = body.internal_forces();
    const VectorX Kv = tangent_times<d>(body, space, v);

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
    "[assembly]", ((int degree), degree), 1, 2, 3) {
    const Volumetric volumetric = GENERATE(Volumetric::full, Volumetric::projected);
    const StoredEnergy energy =
        GENERATE(StoredEnergy::neo_hookean, StoredEnergy::neo_hookean_logarithmic,
                 StoredEnergy::saint_venant_kirchhoff);
    const SpacePtr<3> solid = curved_space<3>(degree);
    check_derivatives<3>(make_reference<3>(solid), Kinematics::solid, energy, volumetric);
    check_derivatives<3>(deformed_reference<3>(solid), Kinematics::solid, energy, volumetric);
    // The exact annulus has degree 2.
    const SpacePtr<2> plane = curved_space<2>(std::max(degree, 2));
    for (const Kinematics kinematics : {Kinematics::plane_strain, Kinematics::axisymmetric}) {
        check_derivatives<2>(make_reference<2>(plane), kinematics, energy, volumetric);
        check_derivatives<2>(deformed_reference<2>(plane), kinematics, energy, volumetric);
    }
}

TEST_CASE("FiniteStrain: a projected dilatation that is constant changes nothing", "[assembly]") {
    const SpacePtr<3> space = curved_space<3>(GENERATE(1, 2));
    const Problem problem = rubber(Kinematics::solid, StoredEnergy::neo_hookean);
    FiniteStrain<3> full(make_reference<3>(space), problem, {}, Volumetric::full);
    FiniteStrain<3> projected(make_reference<3>(space), problem, {}, Volumetric::projected);
    const MatrixX u =
        space->geometry().patches[0].control_points() * Vector3(0.2, -0.1, 0.3).asDiagonal();
    MatrixX by_dof(space->n_dofs(), 3);
    for (int i = 0; i < space->n_dofs(); ++i) {
        by_dof.row(space->dofs(0)[i]) = u.row(i);
    }
    full.deform(by_dof);
    projected.deform(by_dof);
    CHECK(projected.energy() == Approx(full.energy()).epsilon(1e-13));
    CHECK((projected.internal_forces() - full.internal_forces()).cwiseAbs().maxCoeff() < 1e-13);
    const Vector3 xi(0.3, 0.4, 0.7);
    const Matrix<3> H =
        total_displacement_gradient<3>(*make_reference<3>(space), Kinematics::solid, by_dof, 0, xi);
    CHECK((projected.piola_at(0, xi, H) - full.piola_at(0, xi, H)).norm() < 1e-13);
}

TEST_CASE("FiniteStrain: a reference whose F_b folds is named", "[assembly]") {
    const SpacePtr<3> space = curved_space<3>(2);
    const Problem problem = rubber(Kinematics::solid, StoredEnergy::neo_hookean);
    ReferenceConfiguration<3> folded{space, MatrixX::Zero(space->n_dofs(), 3),
                                     MatrixX::Zero(space->n_dofs(), 9)};
    folded.gradient.col(0).setConstant(-1.25);
    CHECK_THROWS_WITH(
        FiniteStrain<3>(std::make_shared<const ReferenceConfiguration<3>>(folded), problem),
        Catch::Matchers::Contains("det F_b = -0.25 in patch 0 at parameter") &&
            Catch::Matchers::Contains("mesh again at an earlier time"));
}

TEST_CASE("FiniteStrain: a rigid rotation needs no forces", "[assembly]") {
    const SpacePtr<3> space = curved_space<3>(2);
    const Problem problem = rubber(Kinematics::solid, StoredEnergy::neo_hookean);
    FiniteStrain<3> body(make_reference<3>(space), problem);
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
    FiniteStrain<3> body(make_reference<3>(space), problem);
    MatrixX u = MatrixX::Zero(space->n_dofs(), 3);
    u.col(2) = -1.5 * space->geometry().patches[0].control_points().col(2);
    const SmallestVolume<3> smallest = body.deform(u);
    CHECK(smallest.det_F == Approx(-0.5).epsilon(1e-12));
    CHECK(smallest.patch == 0);
}

TEST_CASE("FiniteStrain: what it can't take is named", "[assembly]") {
    const SpacePtr<2> space = curved_space<2>(2);
    Problem problem = rubber(Kinematics::plane_stress, StoredEnergy::neo_hookean);
    CHECK_THROWS_WITH(FiniteStrain<2>(make_reference<2>(space), problem),
                      Catch::Matchers::Contains("'plane_stress' holds for linear elasticity only"));
    problem.kinematics = Kinematics::plane_strain;
    problem.materials[0].hyperelastic.reset();
    CHECK_THROWS_WITH(FiniteStrain<2>(make_reference<2>(space), problem),
                      "[material.rubber] of patch 0 is linear elastic, others are hyperelastic; at "
                      "finite strain every material needs a hyperelastic 'model'");
}
