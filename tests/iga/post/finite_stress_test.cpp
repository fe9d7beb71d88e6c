#include "iga/post/finite_stress.h"

#include <Eigen/LU>
#include <catch2/catch.hpp>

#include "iga/core/error.h"
#include "iga/spline/refine.h"
#include "iga/spline/shapes.h"

using namespace couture;
using namespace couture::iga;
using Catch::Matchers::Contains;

namespace {

constexpr double rounding = 1e-12;
/// The solver's residual times the condition of small mass matrices.
constexpr double projection_error = 1e-9;
/// Digits of the printed closed forms.
constexpr double printed = 1e-9;

Problem rubber(Kinematics kinematics) {
    Problem problem;
    problem.kinematics = kinematics;
    problem.materials.resize(1);
    problem.materials[0].name = "rubber";
    problem.materials[0].hyperelastic = make_hyperelastic(StoredEnergy::neo_hookean, 3.0, 20.0);
    return problem;
}

/// Coefficients of (A - I) X on a space whose functions are those of its geometry.
template <int d>
MatrixX affine(const Space<d>& space, const Matrix<d>& A) {
    MatrixX u(space.n_dofs(), d);
    const MatrixX& points = space.geometry().patches[0].control_points();
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
        u.row(space.dofs(0)[i]) = ((A - Matrix<d>::Identity()) * points.row(i).transpose());
    }
    return u;
}

Vector<6> voigt(double xx, double yy, double zz, double yz, double xz, double xy) {
    Vector<6> v;
    v << xx, yy, zz, yz, xz, xy;
    return v;
}

}  // namespace

TEST_CASE("finite_state_at: uniaxial tension has its closed form", "[post]") {
    const double stretch = 1.5;
    const double lateral = 0.8441183553;
    MultiPatch<3> block;
    block.patches = {make_box<3>(Vector3(1.0, 2.0, 3.0))};
    SteppingState<3> state = make_start<3>(std::make_shared<const Space<3>>(block));
    state.displacement =
        affine<3>(*state.reference->space, Vector3(stretch, lateral, lateral).asDiagonal());
    const Problem problem = rubber(Kinematics::solid);
    const FiniteState here = finite_state_at<3>(problem, state, 0, Vector3(0.2, 0.7, 0.4));
    CHECK(here.det_F == Approx(stretch * lateral * lateral).epsilon(rounding));
    CHECK(here.state.stress[0] == Approx(4.1282217920).epsilon(printed));
    CHECK(here.state.stress.tail<5>().cwiseAbs().maxCoeff() < 1e-8);
    const double E = 0.5 * (lateral * lateral - 1.0);
    CHECK((here.state.strain - voigt(0.625, E, E, 0.0, 0.0, 0.0)).norm() < rounding);
    CHECK(deformed_volume<3>(problem, state) ==
          Approx(6.0 * stretch * lateral * lateral).epsilon(rounding));
}

TEST_CASE("finite_state_at: simple shear has engineering shear strains", "[post]") {
    constexpr double g = 0.8;
    MultiPatch<3> block;
    block.patches = {make_box<3>(Vector3(1.0, 1.0, 1.0))};
    SteppingState<3> state = make_start<3>(std::make_shared<const Space<3>>(block));
    Matrix<3> F = Matrix<3>::Identity();
    F(0, 1) = g;
    state.displacement = affine<3>(*state.reference->space, F);
    const FiniteState here =
        finite_state_at<3>(rubber(Kinematics::solid), state, 0, Vector3(0.5, 0.5, 0.5));
    CHECK(here.state.stress[5] == Approx(3.0 * g).epsilon(rounding));
    CHECK(here.state.stress[0] == Approx(2.0 * g * g).epsilon(rounding));
    CHECK(here.state.stress[1] == Approx(-g * g).epsilon(rounding));
    CHECK((here.state.strain - voigt(0.0, 0.5 * g * g, 0.0, 0.0, 0.0, g)).norm() < rounding);
}

TEST_CASE("finite_state_at: a ring that widens has its hoop stretch, also on the axis", "[post]") {
    MultiPatch<2> disk;
    disk.patches = {make_box<2>(Vector2(2.0, 1.0))};
    SteppingState<2> state = make_start<2>(std::make_shared<const Space<2>>(disk));
    state.displacement = affine<2>(*state.reference->space, Vector2(1.25, 0.9).asDiagonal());
    const Problem problem = rubber(Kinematics::axisymmetric);
    for (const double r : {0.0, 0.3}) {
        const FiniteState here = finite_state_at<2>(problem, state, 0, Vector2(r, 0.5));
        CHECK((here.H.diagonal() - Vector3(0.25, -0.1, 0.25)).norm() < rounding);
    }
}

TEST_CASE("finite_state_at: a reference that is deformed already changes nothing", "[post]") {
    Matrix<3> first;
    first << 1.2, 0.3, 0.0, -0.1, 0.9, 0.2, 0.0, 0.1, 1.1;
    Matrix<3> all;
    all << 1.4, 0.2, -0.1, 0.1, 0.8, 0.3, 0.2, 0.0, 1.0;
    MultiPatch<3> block;
    block.patches = {make_box<3>(Vector3(1.0, 1.0, 1.0))};
    const SpacePtr<3> undeformed = std::make_shared<const Space<3>>(block);
    SteppingState<3> direct = make_start<3>(undeformed);
    direct.displacement = affine<3>(*undeformed, all);

    MultiPatch<3> moved = block;
    const MatrixX points = block.patches[0].control_points() * first.transpose();
    moved.patches = {Patch<3>(block.patches[0].space(), points)};
    ReferenceConfiguration<3> reference{
        std::make_shared<const Space<3>>(moved), affine<3>(*undeformed, first), {}};
    reference.gradient.resize(undeformed->n_dofs(), 9);
    for (int i = 0; i < 9; ++i) {
        reference.gradient.col(i).setConstant(first(i / 3, i % 3) - (i / 3 == i % 3 ? 1.0 : 0.0));
    }
    SteppingState<3> later = direct;
    later.reference = std::make_shared<const ReferenceConfiguration<3>>(reference);

    const Problem problem = rubber(Kinematics::solid);
    const Vector3 xi(0.3, 0.6, 0.1);
    const FiniteState a = finite_state_at<3>(problem, direct, 0, xi);
    const FiniteState b = finite_state_at<3>(problem, later, 0, xi);
    CHECK((a.H - (all - Matrix<3>::Identity())).norm() < rounding);
    CHECK((a.H - b.H).norm() < rounding);
    CHECK((a.state.stress - b.state.stress).norm() < 1e-10);
    CHECK(deformed_volume<3>(problem, later) == Approx(all.determinant()).epsilon(rounding));
    const FiniteGaussPoints one = gauss_point_states<3>(problem, direct);
    const FiniteGaussPoints two = gauss_point_states<3>(problem, later);
    CHECK((one.points - two.points).norm() < rounding);
    CHECK((one.displacement - two.displacement).norm() < rounding);
    CHECK((one.stress - two.stress).norm() < 1e-9);
}

TEST_CASE("project_finite_state: uniform states are kept", "[post]") {
    MultiPatch<2> block;
    block.patches = {make_box<2>(Vector2(1.0, 1.0))};
    const SpacePtr<2> space =
        std::make_shared<const Space<2>>(refine<2>(block, 2, std::array<int, 2>{3, 2}));
    SteppingState<2> state = make_start<2>(space);
    state.displacement = affine<2>(*space, Vector2(1.5, 1.0).asDiagonal());
    const Problem problem = rubber(Kinematics::plane_strain);
    const FiniteState here = finite_state_at<2>(problem, state, 0, Vector2(0.5, 0.5));
    const FiniteFields fields = project_finite_state<2>(problem, state);
    CHECK((fields.stress.rowwise() - here.state.stress.transpose()).norm() < projection_error);
    CHECK((fields.strain.rowwise() - here.state.strain.transpose()).norm() < projection_error);
    CHECK((fields.det_F.array() - 1.5).matrix().norm() < projection_error);

    const FiniteGaussPoints points = gauss_point_states<2>(problem, state);
    CHECK(points.points.rows() == 9 * 6);
    CHECK(points.cells.size() == 4 * 6);
    CHECK(points.cells.front() == std::vector<int>{0, 1, 10, 9});
    CHECK((points.displacement.col(0) - 0.5 * points.points.col(0)).norm() < rounding);
}

TEST_CASE("finite_state_at: a linear material is named", "[post]") {
    MultiPatch<2> block;
    block.patches = {make_box<2>(Vector2(1.0, 1.0))};
    Problem problem;
    problem.kinematics = Kinematics::plane_strain;
    problem.materials = {make_isotropic("steel", 1.0, 0.3)};
    const SteppingState<2> state = make_start<2>(std::make_shared<const Space<2>>(block));
    CHECK_THROWS_WITH(finite_state_at<2>(problem, state, 0, Vector2(0.5, 0.5)),
                      Contains("[material.steel]: stresses at finite strain need a hyperelastic"));
}
