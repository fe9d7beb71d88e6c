#include "iga/solve/matrix_free_system.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "iga/assembly/assembler.h"
#include "iga/assembly/elasticity.h"
#include "iga/assembly/loads.h"
#include "iga/core/error.h"
#include "iga/solve/linear_static.h"
#include "iga/solve/static_system.h"
#include "iga/spline/shapes.h"
#include "iga/topology/interface_match.h"

using namespace couture;
using namespace couture::iga;
using Catch::Matchers::Contains;

namespace {

constexpr double tolerance = 1e-10;

/// A quarter annulus extruded (turned about z), or two boxes; sets are sides 0 to 5 of patch 0.
SpacePtr<3> make_space(bool is_annulus, double angle, int degree, int n_elements) {
    MultiPatch<3> part;
    if (is_annulus) {
        const Volume volume =
            make_extrusion(make_quarter_annulus(1.0, 2.0), Vector3(0.0, 0.0, 1.0));
        MatrixX points = volume.control_points();
        Matrix<3> turn = Matrix<3>::Identity();
        turn.topLeftCorner<2, 2>() << std::cos(angle), -std::sin(angle), std::sin(angle),
            std::cos(angle);
        points = points * turn.transpose();
        part.patches = {Volume(volume.space(), points, volume.weights())};
    } else {
        const Volume box = make_box<3>(Vector3(1.0, 1.0, 2.0));
        MatrixX points = box.control_points();
        points.col(0).array() += 1.0;
        part.patches = {box, Volume(box.space(), points)};
    }
    find_interfaces(part);
    for (int side = 0; side < 6; ++side) {
        part.boundary_sets["side_" + std::to_string(side)] = {make_side<3>(0, side)};
    }
    const KnotVector knots = KnotVector::uniform(degree, n_elements);
    std::vector<TensorSpace<3>> spaces(part.patches.size(), {{knots, knots, knots}});
    return std::make_shared<const Space<3>>(std::move(part), std::move(spaces));
}

Problem make_problem(Physics physics) {
    Problem problem;
    problem.physics = physics;
    Material material;
    material.name = "unit";
    material.stiffness = isotropic_stiffness(1.0, 0.3);
    problem.materials = {material};
    BodyForce force;
    for (int c = 0; c < (physics == Physics::poisson ? 1 : 3); ++c) {
        force.components[c] = constant(0.5 + c);
    }
    problem.body_forces = {force};
    return problem;
}

int compare(const SpacePtr<3>& space, const Problem& problem) {
    LinearStaticOptions options;
    options.solver.tolerance = tolerance;
    options.solver.name = "cholmod";
    const auto direct = solve_linear_static(space, problem, options);
    options.solver.name = "matrix_free";
    const auto free = solve_linear_static(space, problem, options);
    CHECK(free.solver.solver == "matrix_free");
    CHECK(free.solver.residual <= tolerance);
    const MatrixX& u = direct.cases[0].displacement.coefficients;
    // Times the condition of these small matrices.
    CHECK((free.cases[0].displacement.coefficients - u).norm() < 1e4 * tolerance * u.norm());
    CHECK(free.cases[0].balance < 1e-7);
    CHECK(free.cases[0].energy == Approx(direct.cases[0].energy).epsilon(1e-6));
    return free.solver.iterations;
}

}  // namespace

TEST_CASE("matrix_free: the solutions of the assembled systems", "[solve]") {
    SECTION("a held side") {
        const int degree = GENERATE(1, 2, 3);
        Problem problem = make_problem(Physics::elasticity);
        problem.supports = {make_support("side_4", 0.1, 0.1, 0.1)};
        CHECK(compare(make_space(true, 0.0, degree, 5), problem) < 80);
    }
    SECTION("Poisson") {
        Problem problem = make_problem(Physics::poisson);
        problem.supports = {make_support("side_4", 0.1, {}, {})};
        CHECK(compare(make_space(true, 0.0, 2, 6), problem) < 30);
    }
    SECTION("two patches") {
        Problem problem = make_problem(Physics::elasticity);
        problem.supports = {make_support("side_0", 0.1, 0.1, 0.1)};
        CHECK(compare(make_space(false, 0.0, 2, 5), problem) < 80);
    }
    SECTION("symmetry planes along and across the axes") {
        for (const double angle : {0.0, 0.3}) {
            Problem problem = make_problem(Physics::elasticity);
            problem.supports = {make_symmetry("side_2"), make_symmetry("side_3"),
                                make_symmetry("side_4")};
            CHECK(compare(make_space(true, angle, 2, 5), problem) < 100);
        }
    }
    SECTION("an elastic foundation alone holds it") {
        Problem problem = make_problem(Physics::elasticity);
        Foundation foundation;
        foundation.on = "side_4";
        for (auto& stiffness : foundation.components) {
            stiffness = constant(2.0);
        }
        problem.foundations = {foundation};
        CHECK(compare(make_space(true, 0.0, 2, 5), problem) < 200);
    }
}

TEST_CASE("matrix_free: iterations hardly grow with elements", "[solve]") {
    Problem problem = make_problem(Physics::elasticity);
    problem.supports = {make_support("side_4", 0.1, 0.1, 0.1)};
    const int coarse = compare(make_space(true, 0.0, 2, 4), problem);
    const int fine = compare(make_space(true, 0.0, 2, 12), problem);
    CHECK(fine < 1.5 * coarse);
}

TEST_CASE("auto: a matrix beyond the memory limit is not formed", "[solve]") {
    Problem problem = make_problem(Physics::elasticity);
    problem.supports = {make_support("side_4", 0.1, 0.1, 0.1)};
    const SpacePtr<3> space = make_space(true, 0.0, 2, 6);
    LinearStaticOptions options;
    const std::size_t needed = matrix_memory(*space, 3);
    const BlockMatrix matrix = assemble(*space, stiffness_form<3>(problem, 1));
    CHECK(needed == Approx(matrix.memory()).epsilon(0.01));
    options.solver.memory_limit = needed;
    const auto result = solve_linear_static(space, problem, options);
    CHECK(result.solver.solver == "matrix_free");
    CHECK_THAT(result.solver.note, Contains("the matrix would take"));
    options.solver.memory_limit = 0;
    CHECK(solve_linear_static(space, problem, options).solver.solver == "cholmod");
}
