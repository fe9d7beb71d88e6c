#include "iga/solve/linear_static.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "iga/assembly/elasticity.h"
#include "iga/core/error.h"
#include "iga/core/parallel.h"
#include "iga/post/norms.h"
#include "iga/post/stress.h"
#include "iga/spline/refine.h"
#include "iga/spline/shapes.h"
#include "iga/topology/interface_match.h"

using namespace couture;
using namespace couture::iga;

namespace {

/// Exact up to the residual of the solver times the condition of these small systems.
constexpr double exact = 1e-11;

/// The six sides as sets "side_0" .. "side_5", and all as "outer".
template <int d>
void name_sides(MultiPatch<d>& part) {
    for (const PatchEntity<d>& side : part.outer_sides()) {
        part.boundary_sets["outer"].push_back(side);
        part.boundary_sets["side_" + std::to_string(side.side())].push_back(side);
    }
}

MultiPatch<3> bar(double length) {
    MultiPatch<3> part;
    part.patches = {make_box<3>(Vector3(length, 1.0, 1.0))};
    name_sides(part);
    return part;
}

template <int d>
SpacePtr<d> space_of(const MultiPatch<d>& part, int degree, std::array<int, d> n_elements) {
    return std::make_shared<const Space<d>>(refine<d>(part, degree, n_elements));
}

}  // namespace

TEST_CASE("solve_linear_static: a bar in tension", "[solve]") {
    const SpacePtr<3> space = space_of<3>(bar(4.0), 2, {4, 2, 2});
    Problem problem;
    problem.materials = {make_isotropic("steel", 200.0, 0.3)};
    problem.supports = {make_symmetry("side_0"), make_symmetry("side_2"), make_symmetry("side_4")};
    Resultant pull;
    pull.on = "side_1";
    pull.force = Vector3(10.0, 0.0, 0.0);
    problem.resultants = {pull};
    LinearStaticOptions options;
    options.solver.name = GENERATE("cholmod", "petsc");
    const LinearStaticResult<3> result = solve_linear_static(space, problem, options);
    const CaseResult<3>& one = result.cases.at(0);
    const VectorX u = one.displacement.value(0, Vector3(1.0, 1.0, 1.0));
    CHECK(u[0] == Approx(10.0 * 4.0 / 200.0).epsilon(1e-9));
    CHECK(u[1] == Approx(-0.3 * 10.0 / 200.0).epsilon(1e-8));
    CHECK(one.energy == Approx(0.5 * 10.0 * 0.2).epsilon(1e-9));
    CHECK(one.reactions.at("side_0")[0] == Approx(-10.0).epsilon(1e-9));
    CHECK(one.balance < 1e-10);
    const StressState s =
        stress_at<3>(problem, one.displacement, one.name, 0, Vector3(0.3, 0.4, 0.5));
    CHECK(s.stress[0] == Approx(10.0).epsilon(1e-8));
    CHECK(von_mises(s.stress) == Approx(10.0).epsilon(1e-8));
    CHECK(principal_stresses(s.stress)[0] == Approx(10.0).epsilon(1e-8));
}

TEST_CASE("solve_linear_static: a needle bends as slender beams do", "[solve]") {
    // Length over thickness 100: rounding of the displacements leaves a residual above any
    // sensible tolerance, and the solution is right to many digits all the same.
    MultiPatch<3> part;
    part.patches = {make_box<3>(Vector3(100.0, 1.0, 1.0))};
    name_sides(part);
    const SpacePtr<3> space = space_of<3>(part, 3, {8, 1, 1});
    Problem problem;
    problem.materials = {make_isotropic("steel", 1e6, 0.0)};
    problem.supports = {make_support("side_0", 0.0, 0.0, 0.0)};
    Resultant push;
    push.on = "side_1";
    push.force = Vector3(0.0, 1e-3, 0.0);
    problem.resultants = {push};
    const LinearStaticResult<3> result = solve_linear_static(space, problem);
    // F L^3 / 3 E I, with I = 1 / 12; shear adds 6e-5 of it.
    const double expected = 1e-3 * 1e6 / (3.0 * 1e6 / 12.0);
    CHECK(result.cases[0].displacement.value(0, Vector3(1.0, 0.5, 0.5))[1] ==
          Approx(expected).epsilon(2e-4));
    CHECK(result.solver.residual > 1e-10);
    CHECK_THAT(result.solver.note,
               Catch::Matchers::Contains("the residual is the rounding of A x"));
}

TEST_CASE("solve_linear_static: load cases share a factorization, combinations add up", "[solve]") {
    const SpacePtr<3> space = space_of<3>(bar(2.0), 2, {2, 1, 1});
    Problem problem;
    problem.materials = {make_isotropic("steel", 100.0, 0.25)};
    problem.materials[0].thermal_expansion = Vector3::Constant(1e-3);
    problem.supports = {make_symmetry("side_0"), make_symmetry("side_2"), make_symmetry("side_4")};
    Pressure pressure;
    pressure.on = "side_1";
    pressure.value = constant(-1.0);
    pressure.load_case = "pull";
    problem.pressures = {pressure};
    Temperature heat;
    heat.change = constant(50.0);
    heat.load_case = "heat";
    problem.temperatures = {heat};
    problem.combinations["both"] = {{"pull", 2.0}, {"heat", -1.0}};
    const LinearStaticResult<3> result = solve_linear_static(space, problem);
    REQUIRE(result.cases.size() == 3);
    const Vector3 tip(1.0, 0.5, 0.5);
    CHECK(result.cases[0].displacement.value(0, tip)[0] == Approx(0.02).epsilon(1e-9));
    CHECK(result.cases[1].displacement.value(0, tip)[0] == Approx(0.1).epsilon(1e-9));
    // Free expansion carries no stress and no energy.
    CHECK(std::abs(result.cases[1].energy) < 1e-12);
    CHECK(stress_at<3>(problem, result.cases[1].displacement, "heat", 0, tip).stress.norm() < 1e-9);
    CHECK(result.cases[2].displacement.value(0, tip)[0] == Approx(-0.06).epsilon(1e-9));
    CHECK(stress_at<3>(problem, result.cases[2].displacement, "both", 0, tip).stress[0] ==
          Approx(2.0).epsilon(1e-8));
    CHECK(result.cases[2].energy == Approx(4.0 * result.cases[0].energy).epsilon(1e-9));
}

TEST_CASE("solve_linear_static: polynomial patch tests on multilinear maps", "[solve]") {
    const int degree = GENERATE(1, 2, 3, 4);
    // A distorted hexahedron.
    MatrixX corners(8, 3);
    corners << 0, 0, 0, 1, 0.1, 0, 0, 1, 0.1, 1.1, 1, 0, 0, 0.1, 1, 1, 0, 1.1, 0.1, 1, 1, 1, 1, 1;
    MultiPatch<3> part;
    part.patches = {make_multilinear<3>(corners)};
    name_sides(part);
    const SpacePtr<3> space = space_of<3>(part, degree, {2, 2, 2});
    // u_a = degree-`degree` power of a linear function; the body force follows from it.
    const Vector3 direction(0.7, -0.4, 0.5);
    const Vector3 amplitude(1.0, 2.0, -1.5);
    const int p = degree;
    const double E = 10.0;
    const double nu = 0.3;
    const double lambda = E * nu / ((1 + nu) * (1 - 2 * nu));
    const double mu = E / (2 * (1 + nu));
    const auto power = [=](const Vector3& x, int derivative) {
        double factor = 1.0;
        for (int k = 0; k < derivative; ++k) {
            factor *= p - k;
        }
        return p < derivative ? 0.0 : factor * std::pow(1.0 + direction.dot(x), p - derivative);
    };
    Problem problem;
    problem.materials = {make_isotropic("steel", E, nu)};
    Support support;
    support.on = "outer";
    BodyForce force;
    for (int a = 0; a < 3; ++a) {
        support.components[a] = [=](const Vector3& x, double) {
            return amplitude[a] * power(x, 0);
        };
        force.components[a] = [=](const Vector3& x, double) {
            return -power(x, 2) * ((lambda + mu) * direction.dot(amplitude) * direction[a] +
                                   mu * direction.squaredNorm() * amplitude[a]);
        };
    }
    problem.supports = {support};
    problem.body_forces = {force};
    LinearStaticOptions options;
    // The map's Jacobian raises the degree of the integrands.
    options.n_gauss_points = degree + 3;
    const LinearStaticResult<3> result = solve_linear_static(space, problem, options);
    const ErrorNorms errors =
        error_norms<3>(result.cases[0].displacement,
                       {[=](const Vector3& x) -> VectorX { return amplitude * power(x, 0); },
                        [=](const Vector3& x) -> MatrixX {
                            return amplitude * direction.transpose() * power(x, 1);
                        }});
    CHECK(errors.l2 < exact * errors.l2_exact);
    CHECK(errors.h1 < exact * errors.h1_exact);
}

TEST_CASE("solve_linear_static: pressurised ring, plane strain and axisymmetric agree with Lame",
          "[solve]") {
    // a = 1, b = 2, p = 1, E = 1000, nu = 0.3: u_r(a) = 1.906666667e-3, u_r(b) = 1.213333333e-3.
    constexpr double u_inner = 1.906666666666667e-3;
    constexpr double u_outer = 1.213333333333333e-3;
    Problem problem;
    problem.materials = {make_isotropic("steel", 1000.0, 0.3)};
    Pressure pressure;
    pressure.value = constant(1.0);
    SECTION("quarter ring") {
        MultiPatch<2> part;
        part.patches = {make_quarter_annulus(1.0, 2.0)};
        name_sides(part);
        problem.kinematics = Kinematics::plane_strain;
        problem.supports = {make_symmetry("side_2"), make_symmetry("side_3")};
        pressure.on = "side_0";
        problem.pressures = {pressure};
        const auto result = solve_linear_static(space_of<2>(part, 4, {8, 4}), problem);
        const Field<2>& u = result.cases[0].displacement;
        CHECK(u.value(0, Vector2(0.0, 0.0)).norm() == Approx(u_inner).epsilon(1e-6));
        CHECK(u.value(0, Vector2(1.0, 0.0)).norm() == Approx(u_outer).epsilon(1e-6));
        const StressState s = stress_at<2>(problem, u, "", 0, Vector2(0.0, 0.5));
        CHECK(principal_stresses(s.stress)[0] == Approx(5.0 / 3.0).epsilon(1e-4));
    }
    SECTION("axisymmetric strip held at both ends") {
        MultiPatch<2> part;
        MatrixX corners(4, 2);
        corners << 1, 0, 2, 0, 1, 0.5, 2, 0.5;
        part.patches = {make_multilinear<2>(corners)};
        name_sides(part);
        problem.kinematics = Kinematics::axisymmetric;
        problem.supports = {make_symmetry("side_2"), make_symmetry("side_3")};
        pressure.on = "side_0";
        problem.pressures = {pressure};
        const auto result = solve_linear_static(space_of<2>(part, 4, {8, 1}), problem);
        const Field<2>& u = result.cases[0].displacement;
        CHECK(u.value(0, Vector2(0.0, 0.5))[0] == Approx(u_inner).epsilon(1e-7));
        CHECK(u.value(0, Vector2(1.0, 0.5))[0] == Approx(u_outer).epsilon(1e-7));
        const StressState s = stress_at<2>(problem, u, "", 0, Vector2(0.0, 0.5));
        CHECK(s.stress[2] == Approx(5.0 / 3.0).epsilon(1e-4));
    }
}

TEST_CASE("solve_linear_static: slanted symmetry planes hold the normal only", "[solve]") {
    // The ring's sector turned by 30 degrees: its cut faces follow no axis.
    const double turn = std::numbers::pi / 6.0;
    MultiPatch<2> part;
    part.patches = {make_ruled(make_arc(1.0, turn, 0.5 * std::numbers::pi),
                               make_arc(2.0, turn, 0.5 * std::numbers::pi))};
    name_sides(part);
    Problem problem;
    problem.kinematics = Kinematics::plane_strain;
    problem.materials = {make_isotropic("steel", 1000.0, 0.3)};
    problem.supports = {make_symmetry("side_0"), make_symmetry("side_1")};
    Pressure pressure;
    pressure.on = "side_2";
    pressure.value = constant(1.0);
    problem.pressures = {pressure};
    const auto result = solve_linear_static(space_of<2>(part, 4, {4, 8}), problem);
    CHECK(result.cases[0].displacement.value(0, Vector2(0.3, 0.0)).norm() ==
          Approx(1.906666667e-3).epsilon(1e-6));
    CHECK(result.cases[0].balance < 1e-10);
}

TEST_CASE("solve_linear_static: moments, foundations and point loads balance", "[solve]") {
    const SpacePtr<3> space = space_of<3>(bar(3.0), 3, {4, 2, 2});
    Problem problem;
    problem.materials = {make_isotropic("steel", 100.0, 0.3)};
    problem.supports = {make_support("side_0", 0.0, 0.0, 0.0)};
    Resultant bend;
    bend.on = "side_1";
    bend.moment = Vector3(0.0, 0.5, 0.0);
    problem.resultants = {bend};
    PointLoad point;
    point.at = Vector3(1.5, 0.5, 0.5);
    point.force = Vector3(0.0, 0.2, 0.0);
    problem.point_loads = {point};
    Foundation springs;
    springs.on = "side_4";
    springs.normal = constant(3.0);
    problem.foundations = {springs};
    const auto result = solve_linear_static(space, problem);
    CHECK(result.cases[0].balance < 1e-10);
    CHECK(result.cases[0].applied_force.isApprox(Vector3(0.0, 0.2, 0.0), 1e-12));
    CHECK(result.cases[0].foundation_force.norm() > 1e-3);
}

TEST_CASE("solve_linear_static: free rigid motions are named", "[solve]") {
    const SpacePtr<3> space = space_of<3>(bar(2.0), 1, {1, 1, 1});
    Problem problem;
    problem.materials = {make_isotropic("steel", 1.0, 0.3)};
    CHECK_THROWS_WITH(solve_linear_static(space, problem),
                      "the body is not held: free rigid-body motions: translation along x, "
                      "translation along y, translation along z, rotation about x, rotation about "
                      "y, rotation about z; add supports ([[fixed]], [[symmetry]], "
                      "[[displacement]]) or a [[foundation]]");
    problem.supports = {make_symmetry("side_0"), make_symmetry("side_2")};
    CHECK_THROWS_WITH(solve_linear_static(space, problem),
                      Catch::Matchers::Contains("motions: translation along z; add"));
    Foundation springs;
    springs.on = "side_4";
    springs.normal = constant(1e-3);
    problem.foundations = {springs};
    CHECK_NOTHROW(solve_linear_static(space, problem));
}

TEST_CASE("solve_linear_static: supports that contradict or can't hold are named", "[solve]") {
    const SpacePtr<3> space = space_of<3>(bar(2.0), 1, {1, 1, 1});
    Problem problem;
    problem.materials = {make_isotropic("steel", 1.0, 0.3)};
    problem.supports = {make_support("side_0", 0.0, 0.0, 0.0), make_support("side_2", 0.1, {}, {})};
    CHECK_THROWS_WITH(solve_linear_static(space, problem),
                      Catch::Matchers::Contains("displacement on 'side_2' contradicts the one on "
                                                "'side_0' at "));
    problem.supports = {make_support("side_7", 0.0, 0.0, 0.0)};
    CHECK_THROWS_AS(solve_linear_static(space, problem), TopologyError);
    problem.supports = {make_support("side_0", 0.0, 0.0, 0.0)};
    problem.materials.clear();
    CHECK_THROWS_WITH(solve_linear_static(space, problem),
                      Catch::Matchers::Contains("patch 0 has no material"));
}

TEST_CASE("solve_linear_static: Poisson on a curved ring", "[solve]") {
    // u = log r is harmonic: flux 1/r on the inner side, u given on the outer.
    MultiPatch<2> part;
    part.patches = {make_quarter_annulus(1.0, 2.0)};
    name_sides(part);
    Problem problem;
    problem.physics = Physics::poisson;
    Material material;
    material.conductivity = 2.0;
    problem.materials = {material};
    problem.supports = {make_support("side_1", std::log(2.0), {}, {})};
    Traction flux;
    flux.on = "side_0";
    flux.components = {constant(-2.0), constant(0.0), constant(0.0)};
    problem.tractions = {flux};
    const auto result = solve_linear_static(space_of<2>(part, 3, {8, 2}), problem);
    CHECK(std::abs(result.cases[0].displacement.value(0, Vector2(0.0, 0.4))[0]) < 1e-5);
    CHECK(result.cases[0].balance < 1e-10);
}

TEST_CASE("solve_linear_static: reactions to prescribed displacements balance", "[solve]") {
    const SpacePtr<3> space = space_of<3>(bar(2.0), 2, {2, 1, 1});
    Problem problem;
    problem.materials = {make_isotropic("steel", 200.0, 0.3)};
    problem.supports = {make_support("side_0", 0.0, 0.0, 0.0),
                        make_support("side_1", 0.1, 0.0, 0.0)};
    const auto result = solve_linear_static(space, problem);
    CHECK(result.cases[0].reactions.at("side_1")[0] > 1.0);
    CHECK(result.cases[0].balance < 1e-12);
}

TEST_CASE("solve_linear_static: a negative foundation is refused", "[solve]") {
    const SpacePtr<3> space = space_of<3>(bar(2.0), 1, {1, 1, 1});
    Problem problem;
    problem.materials = {make_isotropic("steel", 200.0, 0.3)};
    problem.supports = {make_support("side_0", 0.0, 0.0, 0.0)};
    problem.foundations.resize(1);
    problem.foundations[0].on = "side_1";
    problem.foundations[0].normal = constant(-10.0);
    CHECK_THROWS_WITH(
        solve_linear_static(space, problem),
        Catch::Matchers::Contains("foundation on 'side_1': its stiffness is -10 at "));
}

TEST_CASE("body_volume: areas count by thickness or as rings", "[solve]") {
    MultiPatch<2> square;
    square.patches = {make_box<2>(Vector2(1.0, 3.0))};
    Problem problem;
    problem.kinematics = Kinematics::plane_stress;
    problem.thickness = 0.1;
    CHECK(body_volume(problem, square) == Approx(0.3).epsilon(1e-14));
    problem.kinematics = Kinematics::axisymmetric;
    CHECK(body_volume(problem, square) == Approx(3.0 * std::numbers::pi).epsilon(1e-14));
    MultiPatch<2> ring;
    ring.patches = {make_quarter_annulus(1.0, 2.0)};
    CHECK(body_volume(problem, ring) == Approx(14.0 / 3.0 * std::numbers::pi).epsilon(1e-12));
}
