#include "iga/distributed/distributed_static.h"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "iga/core/error.h"
#include "iga/post/stress.h"
#include "tests/iga/distributed/sample_bodies.h"

namespace couture::iga {

namespace {

/// Held at the left, pushed and turned at the right, on springs below.
Problem loaded_row() {
    Problem problem;
    problem.materials = {make_isotropic("steel", 100.0, 0.3)};
    problem.supports = {make_support("left", 0.0, 0.0, 0.0)};
    problem.pressures = {make_pressure("right", 2.0)};
    Resultant turn;
    turn.on = "right";
    turn.force = Vector3(0.0, 1.0, 0.0);
    turn.moment = Vector3(0.3, 0.0, 0.0);
    problem.resultants = {turn};
    PointLoad point;
    point.at = Vector3(1.3, 0.2, 1.0);
    point.force = Vector3(0.0, 0.0, -1.0);
    problem.point_loads = {point};
    Foundation springs;
    springs.on = "bottom";
    springs.normal = constant(10.0);
    problem.foundations = {springs};
    return problem;
}

/// Both ways of one process: the whole in one piece, and as the only rank of several.
void check_equal(const MultiPatch<3>& body, const Problem& problem, const std::string& solver) {
    constexpr std::array<int, 3> n = {3, 4, 3};
    const auto whole = std::make_shared<const Space<3>>(refine<3>(body, 2, n));
    LinearStaticOptions options;
    options.solver.name = "cholmod";
    const LinearStaticResult<3> expected = solve_linear_static<3>(whole, problem, options);

    const Communicator ranks;
    RefinedGeometry<3> geometry(body, 2, n);
    const DistributedSpace<3> space = distribute(geometry, ranks);
    options.solver.name = solver;
    options.solver.tolerance = 1e-11;
    const LinearStaticResult<3> found =
        solve_linear_static<3>(ranks, geometry, space, problem, options);
    REQUIRE(found.n_unknowns == expected.n_unknowns);
    const CaseResult<3>& one = found.cases.front();
    const CaseResult<3>& other = expected.cases.front();
    CHECK(one.energy == Approx(other.energy).epsilon(1e-8));
    CHECK((one.applied_force - other.applied_force).norm() < 1e-10);
    CHECK(one.balance < 1e-7);
    for (const auto& [on, force] : other.reactions) {
        CHECK((one.reactions.at(on) - force).norm() < 1e-7);
    }
    const MatrixX stress =
        project(ranks, space, stress_integrals<3>(problem, one.displacement, one.name));
    const MatrixX whole_stress = project_stress<3>(problem, other.displacement, other.name);
    const double size = other.displacement.coefficients.norm();
    for (int i = 0; i < space.pieces.space->n_dofs(); ++i) {
        const FunctionKey key = space.pieces.functions[i];
        const int dof =
            whole->dofs(JoinedFunctions<3>::patch_of(key))[JoinedFunctions<3>::function_of(key)];
        CHECK((one.displacement.coefficients.row(i) - other.displacement.coefficients.row(dof))
                  .norm() < 1e-7 * size);
        CHECK((stress.row(i) - whole_stress.row(dof)).norm() < 1e-5 * whole_stress.norm());
    }
}

}  // namespace

TEST_CASE("distributed statics on one rank are the serial ones") {
    const std::string solver = GENERATE("petsc", "matrix_free");
    CAPTURE(solver);
    check_equal(three_turned_boxes(), loaded_row(), solver);
}

TEST_CASE("distributed statics: slanted symmetry, prescribed functions") {
    const std::string solver = GENERATE("petsc", "matrix_free");
    MultiPatch<3> body = three_turned_boxes();
    // Turned, so that the plane of symmetry is not along an axis.
    const Matrix<3> turn =
        Eigen::AngleAxisd(0.4, Vector3(1.0, 2.0, -1.0).normalized()).toRotationMatrix();
    for (Patch<3>& patch : body.patches) {
        patch = Patch<3>(patch.space(), patch.control_points() * turn.transpose());
    }
    Problem problem;
    problem.materials = {make_isotropic("steel", 100.0, 0.3)};
    problem.supports = {make_symmetry("bottom"), make_support("left", 0.0, 0.0, 0.0)};
    Support pulled;
    pulled.on = "right";
    pulled.components[0] = [](const Vector3& x, double) { return 0.01 * (1.0 + x[1] * x[1]); };
    problem.supports.push_back(pulled);
    problem.supports.erase(problem.supports.begin());
    check_equal(body, problem, solver);
    problem.supports = {make_symmetry("bottom"), make_support("left", 0.0, 0.0, 0.0)};
    problem.pressures = {make_pressure("right", 1.0)};
    check_equal(body, problem, solver);
}

TEST_CASE("distributed statics: what is wrong is said") {
    const Communicator ranks;
    RefinedGeometry<3> geometry(three_turned_boxes(), 2, {{2, 2, 2}});
    const DistributedSpace<3> space = distribute(geometry, ranks);
    Problem problem = loaded_row();
    LinearStaticOptions options;
    options.solver.name = "cholmod";
    CHECK_THROWS_WITH(solve_linear_static<3>(ranks, geometry, space, problem, options),
                      Catch::Contains("works in one process"));
    options.solver.name = "petsc";
    problem.supports.clear();
    problem.foundations.clear();
    CHECK_THROWS_WITH(solve_linear_static<3>(ranks, geometry, space, problem, options),
                      Catch::Contains("free rigid-body motions"));
    problem = loaded_row();
    problem.point_loads[0].at = Vector3(1.0, 1.0, 7.0);
    CHECK_THROWS_WITH(solve_linear_static<3>(ranks, geometry, space, problem, options),
                      Catch::Contains("outside the body"));
}

}  // namespace couture::iga
