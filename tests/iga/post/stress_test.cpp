#include "iga/post/stress.h"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>

#include "iga/topology/locator.h"
#include "tests/iga/post/quadratic_fields.h"

using namespace couture;
using namespace couture::iga;

namespace {

constexpr double rounding = 1e-12;
/// The solver's residual times the condition of small mass matrices.
constexpr double projection_error = 1e-9;

Vector<6> some_stress() {
    Vector<6> stress;
    stress << 3.0, -1.5, 0.7, 0.4, -2.2, 1.1;
    return stress;
}

Vector<6> to_voigt(const Matrix<3>& tensor) {
    Vector<6> stress;
    stress << tensor(0, 0), tensor(1, 1), tensor(2, 2), tensor(1, 2), tensor(0, 2), tensor(0, 1);
    return stress;
}

/// Turned about three axes.
Vector<6> turned(const Vector<6>& stress) {
    const Matrix<3> Q =
        (Eigen::AngleAxisd(0.7, Vector3::UnitX()) * Eigen::AngleAxisd(-1.9, Vector3::UnitZ()) *
         Eigen::AngleAxisd(2.3, Vector3::UnitY()))
            .toRotationMatrix();
    return to_voigt(Q * to_tensor(stress) * Q.transpose());
}

Problem problem_of(const ElasticStiffness& stiffness, Kinematics kinematics) {
    Material material;
    material.name = "steel";
    material.stiffness = stiffness;
    Problem problem;
    problem.kinematics = kinematics;
    problem.materials = {material};
    return problem;
}

/// Strain and stress by definition, in Voigt order.
template <int d>
Vector<6> strain_of(const MatrixX& gradient) {
    Matrix<3> full = Matrix<3>::Zero();
    full.topLeftCorner<d, d>() = gradient;
    Vector<6> strain = to_voigt(full + full.transpose());
    strain.head<3>() *= 0.5;
    return strain;
}

}  // namespace

TEST_CASE("to_tensor: places Voigt order 11, 22, 33, 23, 13, 12", "[post]") {
    Matrix<3> expected;
    expected << 3.0, 1.1, -2.2, 1.1, -1.5, 0.4, -2.2, 0.4, 0.7;
    CHECK(to_tensor(some_stress()) == expected);
}

TEST_CASE("von_mises: tension, shear and pressure", "[post]") {
    Vector<6> pressure = Vector<6>::Zero();
    pressure.head<3>().setConstant(-5.0);
    CHECK(von_mises(pressure) == 0.0);
    for (int i = 0; i < 3; ++i) {
        CHECK(von_mises(-4.0 * Vector<6>::Unit(i)) == Approx(4.0));
        CHECK(von_mises(4.0 * Vector<6>::Unit(3 + i)) == Approx(4.0 * std::sqrt(3.0)));
    }
}

TEST_CASE("von_mises: neither turning nor pressure changes it, scaling scales it", "[post]") {
    const Vector<6> stress = some_stress();
    const double expected = von_mises(stress);
    CHECK(von_mises(turned(stress)) == Approx(expected).epsilon(rounding));
    Vector<6> pressed = stress;
    pressed.head<3>().array() += 100.0;
    CHECK(von_mises(pressed) == Approx(expected).epsilon(1e-11));
    CHECK(von_mises(-3.0 * stress) == Approx(3.0 * expected).epsilon(rounding));
    // By its other definition: sqrt(3/2 s : s) of the deviator.
    const Matrix<3> tensor = to_tensor(stress);
    const Matrix<3> deviator = tensor - tensor.trace() / 3.0 * Matrix<3>::Identity();
    CHECK(std::sqrt(1.5) * deviator.norm() == Approx(expected).epsilon(rounding));
}

TEST_CASE("principal_stresses: descend, keep the invariants, and are found again after turning",
          "[post]") {
    const Vector<6> stress = some_stress();
    const Vector3 principal = principal_stresses(stress);
    CHECK(principal[0] > principal[1]);
    CHECK(principal[1] > principal[2]);
    const Matrix<3> tensor = to_tensor(stress);
    CHECK(principal.sum() == Approx(tensor.trace()).epsilon(rounding));
    CHECK(principal.prod() == Approx(tensor.determinant()).epsilon(rounding));
    CHECK(principal.squaredNorm() == Approx(tensor.squaredNorm()).epsilon(rounding));
    CHECK((principal_stresses(turned(stress)) - principal).norm() < 10.0 * rounding);
    Vector<6> diagonal = Vector<6>::Zero();
    diagonal.head<3>() << 1.0, 3.0, -2.0;
    CHECK((principal_stresses(turned(diagonal)) - Vector3(3.0, 1.0, -2.0)).norm() <
          10.0 * rounding);
    diagonal.head<3>() = principal;
    CHECK(von_mises(diagonal) == Approx(von_mises(stress)).epsilon(rounding));
}

TEST_CASE("stress_at: is stiffness times the symmetric gradient", "[post]") {
    const auto space = std::make_shared<const Space<3>>(make_two_boxes<3>(2, 2));
    const QuadraticFunction<3> function(3);
    const Field<3> u = function.field_on(space);
    const ElasticStiffness D = isotropic_stiffness(10.0, 0.3);
    const Problem problem = problem_of(D, Kinematics::solid);
    const Vector3 xi(0.3, 0.8, 0.6);
    const StressState state = stress_at<3>(problem, u, "", 1, xi);
    const Vector<6> strain = strain_of<3>(function.gradient(xi + Vector3::UnitX()));
    CHECK((state.strain - strain).norm() < rounding);
    CHECK((state.stress - D * strain).norm() < 10.0 * rounding);
}

TEST_CASE("stress_at: plane stress has none across the plane, plane strain no strain", "[post]") {
    const auto space = std::make_shared<const Space<2>>(make_two_boxes<2>(2, 2));
    const QuadraticFunction<2> function(2);
    const Field<2> u = function.field_on(space);
    // Coupled across the plane, so that shear strains arise there too.
    ElasticStiffness D = isotropic_stiffness(10.0, 0.3);
    D(0, 3) = D(3, 0) = 0.9;
    D(2, 4) = D(4, 2) = -0.7;
    const Vector2 xi(0.3, 0.8);
    const Vector<6> in_plane = strain_of<2>(function.gradient(Vector3(0.3, 0.8, 0.0)));
    const StressState strained =
        stress_at<2>(problem_of(D, Kinematics::plane_strain), u, "", 0, xi);
    CHECK((strained.strain - in_plane).norm() < rounding);
    CHECK((strained.stress - D * in_plane).norm() < 10.0 * rounding);
    const StressState stressed =
        stress_at<2>(problem_of(D, Kinematics::plane_stress), u, "", 0, xi);
    for (const int across : {2, 3, 4}) {
        CHECK(std::abs(stressed.stress[across]) < rounding);
        CHECK(std::abs(stressed.strain[across]) > 0.01);
    }
    // Strain and stress belong together.
    CHECK((D * stressed.strain - stressed.stress).norm() < 10.0 * rounding);
}

TEST_CASE("stress_at: a heated body that is held carries -E alpha dT / (1 - 2 nu)", "[post]") {
    const auto space = std::make_shared<const Space<3>>(make_two_boxes<3>(1, 1));
    const Field<3> held{space, MatrixX::Zero(space->n_dofs(), 3)};
    Problem problem = problem_of(isotropic_stiffness(10.0, 0.3), Kinematics::solid);
    problem.materials[0].thermal_expansion.setConstant(1e-3);
    Temperature heat;
    heat.change = constant(20.0);
    heat.load_case = "heat";
    problem.temperatures = {heat};
    const Vector3 xi(0.5, 0.5, 0.5);
    const StressState hot = stress_at<3>(problem, held, "heat", 0, xi);
    CHECK(hot.stress[0] == Approx(-10.0 * 1e-3 * 20.0 / 0.4));
    CHECK(hot.stress.tail<3>().norm() < rounding);
    CHECK(hot.strain.norm() == 0.0);
    CHECK(stress_at<3>(problem, held, "cold", 0, xi).stress.norm() == 0.0);
}

TEST_CASE("stress_at: for Poisson holds minus conductivity times the gradient", "[post]") {
    const auto space = std::make_shared<const Space<2>>(make_two_boxes<2>(2, 1));
    const QuadraticFunction<2> function(1);
    Problem problem;
    problem.physics = Physics::poisson;
    problem.materials.resize(1);
    problem.materials[0].conductivity = 3.0;
    const StressState state =
        stress_at<2>(problem, function.field_on(space), "", 0, Vector2(0.2, 0.9));
    const MatrixX gradient = function.gradient(Vector3(0.2, 0.9, 0.0));
    CHECK((state.stress.head<2>() + 3.0 * gradient.transpose()).norm() < rounding);
    CHECK(state.stress.tail<4>().norm() == 0.0);
}

TEMPLATE_TEST_CASE_SIG("project_stress: reproduces a linear stress", "[post]", ((int d), d), 2, 3) {
    const auto space = std::make_shared<const Space<d>>(make_two_boxes<d>(GENERATE(2, 3), 2));
    const QuadraticFunction<d> function(d);
    const Field<d> u = function.field_on(space);
    const Problem problem = problem_of(
        isotropic_stiffness(10.0, 0.3),
        d == 2 ? GENERATE(Kinematics::plane_strain, Kinematics::plane_stress) : Kinematics::solid);
    const Field<d> stress{space, project_stress<d>(problem, u, "")};
    REQUIRE(stress.coefficients.cols() == 6);
    for (int patch = 0; patch < 2; ++patch) {
        for (const double t : {0.0, 0.23, 0.5, 1.0}) {
            const Vector<d> xi = Vector<d>::Constant(t);
            const Vector<6> expected = stress_at<d>(problem, u, "", patch, xi).stress;
            CHECK((stress.value(patch, xi) - expected).norm() <
                  projection_error * (1.0 + expected.norm()));
        }
    }
}

TEST_CASE("project_stress: at a jump of material shows the mean", "[post]") {
    const auto space = std::make_shared<const Space<2>>(make_two_boxes<2>(1, 1));
    const QuadraticFunction<2> function(2);
    Field<2> u{space, MatrixX(space->n_dofs(), 2)};
    // u_x = x stretches both boxes alike.
    for (int p = 0; p < 2; ++p) {
        for (int i = 0; i < 4; ++i) {
            u.coefficients.row(space->dofs(p)[i])
                << space->geometry().patches[p].control_points()(i, 0),
                0.0;
        }
    }
    Problem problem = problem_of(isotropic_stiffness(1.0, 0.0), Kinematics::plane_strain);
    problem.materials[0].patches = {0};
    problem.materials.push_back(problem.materials[0]);
    problem.materials[1].patches = {1};
    problem.materials[1].stiffness *= 3.0;
    const Field<2> stress{space, project_stress<2>(problem, u, "")};
    const double at_interface = stress.value(0, Vector2(1.0, 0.5))[0];
    CHECK(at_interface == Approx(2.0).epsilon(projection_error));
    CHECK(stress.value(1, Vector2(0.0, 0.5))[0] == Approx(at_interface));
}

TEST_CASE("gauss_point_stresses: one row for each Gauss point of each element", "[post]") {
    const auto space = std::make_shared<const Space<3>>(make_two_boxes<3>(2, 2));
    const QuadraticFunction<3> function(3);
    const Field<3> u = function.field_on(space);
    const Problem problem = problem_of(isotropic_stiffness(10.0, 0.3), Kinematics::solid);
    const GaussPointStresses result = gauss_point_stresses<3>(problem, u, "");
    // Two patches, 2^3 elements each, 3^3 points each.
    REQUIRE(result.points.rows() == 2 * 8 * 27);
    REQUIRE(result.stresses.rows() == result.points.rows());
    CHECK(result.points.leftCols(1).minCoeff() > 0.0);
    CHECK(result.points.leftCols(1).maxCoeff() < 2.0);
    const Locator<3> locator(space->geometry());
    for (Eigen::Index i = 0; i < result.points.rows(); i += 17) {
        const Vector3 point = result.points.row(i).transpose();
        const auto location = locator.find(point, 1e-10);
        REQUIRE(location);
        const Vector<6> expected =
            stress_at<3>(problem, u, "", location->patch, location->xi).stress;
        CHECK((result.stresses.row(i).transpose() - expected).norm() < 1e-9);
    }
}
