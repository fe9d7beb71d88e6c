#include "iga/linalg/fast_diagonalization.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>
#include <numbers>
#include <random>

#include "iga/assembly/assembler.h"
#include "iga/assembly/constraints.h"
#include "iga/assembly/elasticity.h"
#include "iga/core/error.h"
#include "iga/linalg/system_checks.h"
#include "iga/spline/shapes.h"
#include "iga/topology/interface_match.h"
#include "tests/iga/topology/test_patches.h"

using namespace couture;
using namespace couture::iga;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;
using std::numbers::pi;

namespace {

constexpr double tolerance = 1e-10;
/// Rounding of operators on a thousand unknowns.
constexpr double rounding = 1e-9;

VectorX random_vector(int n, unsigned seed) {
    std::mt19937 generator(seed);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    return VectorX::NullaryExpr(n, [&]() { return uniform(generator); });
}

/// Holds these components of a set.
Support hold(const std::string& on, const std::vector<int>& components) {
    Support support;
    support.on = on;
    for (const int c : components) {
        support.components[c] = constant(0.0);
    }
    return support;
}

/// A problem on a space, assembled.
template <int d>
struct Model {
    std::shared_ptr<const Space<d>> space;
    BlockMatrix matrix;
    std::vector<char> is_fixed;
    MatrixX modes;

    [[nodiscard]] LinearSystem system() const { return {matrix, is_fixed, modes, space.get()}; }
    [[nodiscard]] VectorX load(unsigned seed) const {
        return free_part(is_fixed, random_vector(matrix.n_unknowns(), seed));
    }
};

template <int d>
Model<d> make_model(Physics physics, const MultiPatch<d>& part, int degree, int n_elements,
                    const std::vector<Support>& supports) {
    Problem problem;
    problem.physics = physics;
    problem.kinematics = d == 2 ? Kinematics::plane_strain : Kinematics::solid;
    Material material;
    material.name = "unit";
    material.conductivity = 1.0;
    material.stiffness = isotropic_stiffness(1.0, 0.3);
    problem.materials = {material};
    problem.supports = supports;
    std::vector<TensorSpace<d>> spaces;
    for (const Patch<d>& patch : part.patches) {
        TensorSpace<d> tensor = patch.space();
        for (KnotVector& knots : tensor.knots) {
            knots = KnotVector::uniform(degree, n_elements, knots.front(), knots.back());
        }
        spaces.push_back(tensor);
    }
    Model<d> model;
    model.space = std::make_shared<const Space<d>>(part, spaces);
    model.matrix = assemble(*model.space, stiffness_form<d>(problem, part.n_patches()));
    model.is_fixed = make_constraints(*model.space, problem, {""}).is_fixed;
    std::vector<std::string> names;
    model.modes = rigid_body_modes(*model.space, problem, names);
    return model;
}

template <int d>
MultiPatch<d> with_sets(std::vector<Patch<d>> patches) {
    MultiPatch<d> part;
    part.patches = std::move(patches);
    find_interfaces(part);
    // Lowest and highest sides by coordinate, whatever their orientation.
    const MatrixX box = part.bounding_box();
    const std::array<std::string, 3> axes{"x", "y", "z"};
    for (const PatchEntity<d>& side : part.outer_sides()) {
        const Patch<d>& patch = part.patches[side.patch];
        for (int axis = 0; axis < d; ++axis) {
            for (int end = 0; end < 2; ++end) {
                bool is_there = true;
                for (const int i : functions_on<d>(patch.space(), side.position)) {
                    is_there = is_there &&
                               std::abs(patch.control_points()(i, axis) - box(axis, end)) < 1e-9;
                }
                if (is_there) {
                    part.boundary_sets[axes[axis] + (end == 0 ? "_low" : "_high")].push_back(side);
                }
            }
        }
    }
    return part;
}

MultiPatch<3> annulus() {
    return with_sets<3>({make_extrusion(make_quarter_annulus(1.0, 2.0), Vector3(0.0, 0.0, 1.0))});
}

/// 2 x 2 x 2 boxes, each with its directions in another order.
MultiPatch<3> odd_boxes() {
    const std::array<std::array<int, 3>, 4> axes{{{0, 1, 2}, {1, 2, 0}, {2, 1, 0}, {1, 0, 2}}};
    std::vector<Patch<3>> patches;
    for (int i = 0; i < 8; ++i) {
        const Patch<3> box = make_unit_box<3>(1, 1, Vector3(i % 2, i / 2 % 2, i / 4));
        patches.push_back(reoriented<3>(box, axes[i % 4], {i % 3 == 0, i % 2 == 1, i > 4}));
    }
    return with_sets<3>(patches);
}

/// An L: the interface of patches 1 and 2 ends on an edge where patch 0 has another one.
MultiPatch<3> bent_boxes() {
    return with_sets<3>({make_unit_box<3>(1, 1), make_unit_box<3>(1, 1, Vector3(1.0, 0.0, 0.0)),
                         make_unit_box<3>(1, 1, Vector3(0.0, 1.0, 0.0))});
}

SolverOptions fast_options() {
    SolverOptions options;
    options.name = "fast_diagonalization";
    options.tolerance = tolerance;
    return options;
}

template <int d>
int n_iterations(const Model<d>& model) {
    const auto solver = make_linear_solver(fast_options());
    solver->factorize(model.system());
    MatrixX x;
    const SolveReport report = solver->solve(model.load(3), x);
    CHECK(report.solver == "fast_diagonalization");
    CHECK(report.residual <= tolerance);
    CHECK(report.memory > 0);
    return report.iterations;
}

/// The same solution as Cholesky's. @return iterations
template <int d>
int compare_with_cholmod(const Model<d>& model) {
    const auto solver = make_linear_solver(fast_options());
    solver->factorize(model.system());
    SolverOptions options;
    options.name = "cholmod";
    const auto direct = make_linear_solver(options);
    direct->factorize(model.system());
    MatrixX b(model.matrix.n_unknowns(), 2);
    b << model.load(1), model.load(2);
    MatrixX x;
    MatrixX exact;
    const SolveReport report = solver->solve(b, x);
    static_cast<void>(direct->solve(b, exact));
    // Times the condition of these small matrices.
    CHECK((x - exact).norm() < 1e5 * tolerance * exact.norm());
    return report.iterations;
}

template <int d>
void check_positive_definite(const Model<d>& model) {
    const FastDiagonalization preconditioner(model.system());
    const int n = model.matrix.n_unknowns();
    std::vector<int> free_unknowns;
    for (int i = 0; i < n; ++i) {
        if (model.is_fixed[i] == 0) {
            free_unknowns.push_back(i);
        }
    }
    const auto n_free = static_cast<Eigen::Index>(free_unknowns.size());
    MatrixX P(n_free, n_free);
    for (Eigen::Index k = 0; k < n_free; ++k) {
        const VectorX column = preconditioner.apply(VectorX::Unit(n, free_unknowns[k]));
        CHECK((column - free_part(model.is_fixed, column)).isZero(0.0));
        P.col(k) = column(free_unknowns);
    }
    CHECK((P - P.transpose()).norm() < rounding * P.norm());
    CHECK(Eigen::LLT<MatrixX>(P).info() == Eigen::Success);
}

}  // namespace

TEST_CASE("Univariate: coefficients reproduce xi and xi^2, eigenvectors are orthonormal",
          "[linalg]") {
    const int degree = GENERATE(1, 2, 3, 4);
    std::vector<double> knots(degree + 1, 2.0);
    knots.insert(knots.end(), {2.5, 3.5, 5.0});
    knots.insert(knots.end(), degree + 1, 6.0);
    const Univariate u = make_univariate(KnotVector(degree, knots));
    CHECK(u.integral.sum() == Approx(1.0));
    CHECK(u.integral.dot(u.linear) == Approx(0.5));
    // Derivatives of 1, xi and xi^2 on [0, 1].
    CHECK((u.stiffness * VectorX::Ones(u.size())).norm() < rounding);
    CHECK(u.linear.dot(u.stiffness * u.linear) == Approx(1.0));
    CHECK(u.linear.dot(u.stiffness * u.square) == Approx(1.0));
    if (degree > 1) {
        CHECK(u.square.dot(u.stiffness * u.square) == Approx(4.0 / 3.0));
        CHECK(u.integral.dot(u.square) == Approx(1.0 / 3.0));
    }
    const Eigenbasis basis = make_eigenbasis(u, true, false);
    const int n = u.size() - 1;
    REQUIRE(basis.size() == n);
    CHECK(basis.first == 1);
    const MatrixX& V = basis.vectors;
    CHECK((V.transpose() * u.mass.bottomRightCorner(n, n) * V).isIdentity(rounding));
    CHECK((V.transpose() * u.stiffness.bottomRightCorner(n, n) * V)
              .isApprox(MatrixX(basis.values.asDiagonal()), rounding));
    // Functions that vanish at 0 only: pi^2 / 4 from above.
    CHECK(basis.values[0] >= 0.25 * pi * pi - rounding);
}

TEST_CASE("patch_coefficients: the stretches of a box, times the material", "[linalg]") {
    const int degree = GENERATE(1, 2, 3);
    const Vector3 size(2.0, 3.0, 5.0);
    const auto part = with_sets<3>({make_box<3>(size)});
    const auto model = make_model<3>(Physics::elasticity, part, degree, 4, {});
    const auto coefficients =
        patch_coefficients(model.matrix, make_patch_structure(*model.space), 0);
    REQUIRE(coefficients.size() == 3);
    const double mu = 1.0 / 2.6;
    const double lambda = 0.3 / (1.3 * 0.4);
    for (int c = 0; c < 3; ++c) {
        CHECK(coefficients[c].reaction == 0.0);
        for (int k = 0; k < 3; ++k) {
            const double modulus = k == c ? lambda + 2.0 * mu : mu;
            CHECK(coefficients[c].stretch[k] ==
                  Approx(modulus * size.prod() / (size[k] * size[k])));
        }
    }
}

TEST_CASE("PatchPreconditioner: inverts Poisson's matrix on a box", "[linalg]") {
    const int degree = GENERATE(1, 2, 3, 4);
    const auto part = with_sets<3>({make_box<3>(Vector3(1.0, 3.0, 0.2))});
    const auto model =
        make_model<3>(Physics::poisson, part, degree, 5, {hold("x_low", {0}), hold("z_high", {0})});
    const PatchPreconditioner patches(model.matrix, model.is_fixed,
                                      make_patch_structure(*model.space));
    const VectorX b = model.load(5);
    CHECK(residual(model.matrix, model.is_fixed, b, patches.apply(b)).norm() < rounding * b.norm());
    // With the coarse functions added, the eigenvalues are 1 and 2.
    CHECK(n_iterations(model) <= 2);
}

TEST_CASE("FastDiagonalization: symmetric positive definite", "[linalg]") {
    check_positive_definite(
        make_model<3>(Physics::elasticity, annulus(), 2, 2, {hold("z_low", {0, 1, 2})}));
    check_positive_definite(
        make_model<3>(Physics::poisson, odd_boxes(), 2, 2, {hold("x_high", {0})}));
    check_positive_definite(
        make_model<3>(Physics::poisson, bent_boxes(), 3, 2, {hold("y_low", {0})}));
}

TEST_CASE("fast_diagonalization: iterations hardly depend on elements and degree", "[linalg]") {
    const std::vector<Support> held{hold("z_low", {0, 1, 2})};
    const std::vector<Support> held_scalar{hold("z_low", {0})};
    // Measured: 15 to 21; elasticity 45 and 57; 8 patches 19 and 25.
    for (const auto& [degree, n] : {std::pair{1, 4}, {1, 12}, {2, 8}, {4, 4}}) {
        CHECK(n_iterations(make_model<3>(Physics::poisson, annulus(), degree, n, held_scalar)) <=
              24);
    }
    CHECK(n_iterations(make_model<3>(Physics::elasticity, annulus(), 1, 6, held)) <= 65);
    CHECK(n_iterations(make_model<3>(Physics::elasticity, annulus(), 3, 4, held)) <= 65);
    CHECK(n_iterations(make_model<3>(Physics::poisson, odd_boxes(), 1, 6, held_scalar)) <= 28);
    CHECK(n_iterations(make_model<3>(Physics::poisson, odd_boxes(), 3, 3, held_scalar)) <= 28);
}

TEST_CASE("fast_diagonalization: several patches in odd orientations, as Cholesky", "[linalg]") {
    const std::vector<Support> held{hold("z_low", {0, 1, 2})};
    CHECK(compare_with_cholmod(make_model<3>(Physics::elasticity, odd_boxes(), 2, 2, held)) < 60);
    CHECK(compare_with_cholmod(make_model<3>(Physics::elasticity, bent_boxes(), 2, 3, held)) < 60);
    CHECK(compare_with_cholmod(
              make_model<2>(Physics::elasticity,
                            with_sets<2>({make_unit_box<2>(1, 1),
                                          reoriented<2>(make_unit_box<2>(1, 1, Vector2(1.0, 0.0)),
                                                        {1, 0}, {true, false})}),
                            2, 6, {hold("x_low", {0, 1})})) < 60);
}

TEST_CASE("fast_diagonalization: supports that hold components on different sides, or no side",
          "[linalg]") {
    // Each component slides but on one side.
    const std::vector<Support> sliding{hold("x_low", {0}), hold("y_low", {1}), hold("z_low", {2})};
    CHECK(compare_with_cholmod(make_model<3>(Physics::elasticity,
                                             with_sets<3>({make_box<3>(Vector3(1.0, 2.0, 1.0))}), 2,
                                             4, sliding)) < 60);
    CHECK(compare_with_cholmod(make_model<3>(Physics::elasticity, odd_boxes(), 1, 3, sliding)) <
          60);
    // No side holds components 0 and 1: a corner and an edge do.
    MultiPatch<3> part = with_sets<3>({make_box<3>(Vector3(1.0, 2.0, 1.0))});
    part.boundary_sets["corner"] = {{0, {End::low, End::low, End::low}}};
    part.boundary_sets["edge"] = {{0, {End::low, End::free, End::low}}};
    const std::vector<Support> loose{hold("z_low", {2}), hold("corner", {0, 1}), hold("edge", {0})};
    CHECK(compare_with_cholmod(make_model<3>(Physics::elasticity, part, 2, 4, loose)) < 60);
}

TEST_CASE("fast_diagonalization: a patch that meets itself, and one that collapses", "[linalg]") {
    MultiPatch<3> ring;
    MatrixX section(4, 2);
    section << 1.0, 0.0, 2.0, 0.0, 1.0, 1.0, 2.0, 1.0;
    ring.patches = {make_revolution(make_multilinear<2>(section), 2.0 * pi)};
    ring = refine<3>(ring, 2, std::array<int, 3>{3, 3, 8});
    find_interfaces(ring);
    REQUIRE(ring.interfaces.size() == 1);
    ring.boundary_sets["end"] = {make_side<3>(0, 2)};
    Model<3> model;
    Problem problem;
    Material material;
    material.stiffness = isotropic_stiffness(1.0, 0.3);
    problem.materials = {material};
    problem.supports = {hold("end", {0, 1, 2})};
    const auto fill = [&](const MultiPatch<3>& part) {
        model.space = std::make_shared<const Space<3>>(part);
        model.matrix = assemble(*model.space, stiffness_form<3>(problem, 1));
        model.is_fixed = make_constraints(*model.space, problem, {""}).is_fixed;
    };
    fill(ring);
    CHECK(compare_with_cholmod(model) < 90);
    MultiPatch<3> shell;
    shell.patches = {make_sphere_shell_patch(1.0, 2.0)};
    shell = refine<3>(shell, 2, std::array<int, 3>{3, 4, 4});
    shell.boundary_sets["end"] = {make_side<3>(0, 4)};
    fill(shell);
    CHECK(compare_with_cholmod(model) < 95);
}

TEST_CASE("fast_diagonalization: what it can't solve is named", "[linalg]") {
    const auto model = make_model<3>(Physics::poisson, annulus(), 2, 4, {hold("z_low", {0})});
    const auto solver = make_linear_solver(fast_options());
    CHECK_THROWS_WITH(solver->factorize({model.matrix, model.is_fixed, {}}),
                      "fast_diagonalization: the system has no space; use cholmod or petsc");
    const auto other = make_model<3>(Physics::poisson, annulus(), 1, 2, {});
    CHECK_THROWS_WITH(solver->factorize({model.matrix, {}, {}, other.space.get()}),
                      "fast_diagonalization: the space has 27 functions, the matrix 216 block "
                      "rows");
    CHECK_THROWS_WITH(solver->factorize({model.matrix, {}, model.modes, model.space.get()}),
                      Contains("1 of 1 rigid-body motions are unconstrained"));
    SolverOptions options = fast_options();
    options.max_iterations = 3;
    const auto hasty = make_linear_solver(options);
    hasty->factorize(model.system());
    MatrixX x;
    CHECK_THROWS_WITH(hasty->solve(model.load(1), x),
                      StartsWith("fast_diagonalization: stopped after 3 iterations with "
                                 "|b - A x| / |b| = ") &&
                          Contains("raise max_iterations or use cholmod"));
    BlockMatrix negative = model.matrix;
    for (double& value : negative.values) {
        value = -value;
    }
    const auto run = [&] {
        solver->factorize({negative, model.is_fixed, {}, model.space.get()});
        static_cast<void>(solver->solve(model.load(1), x));
    };
    CHECK_THROWS_WITH(run(), Contains("not positive definite"));
}

TEST_CASE("auto: fast diagonalization when the factor is too large, petsc when that stalls",
          "[linalg]") {
    const auto model = make_model<3>(Physics::poisson, annulus(), 2, 6, {hold("z_low", {0})});
    SolverOptions options;
    options.memory_limit = 10000;
    MatrixX x;
    const auto solver = make_linear_solver(options);
    solver->factorize(model.system());
    SolveReport report = solver->solve(model.load(1), x);
    CHECK(report.solver == "fast_diagonalization");
    CHECK_THAT(report.note, StartsWith("fell back to fast_diagonalization: cholmod: the factor "));

    options.max_iterations = 2;
    options.petsc_options = "-ksp_type preonly -pc_type cholesky";
    const auto hasty = make_linear_solver(options);
    hasty->factorize(model.system());
    report = hasty->solve(model.load(1), x);
    CHECK(report.solver == "petsc");
    CHECK(report.residual <= tolerance);
    CHECK_THAT(report.note,
               Contains("fell back to petsc: fast_diagonalization: stopped after 2 iterations"));
}
