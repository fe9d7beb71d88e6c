#include "iga/linalg/sparse_solver.h"

#include <catch2/catch.hpp>
#include <random>

#include "iga/core/error.h"
#include "tests/iga/linalg/model_systems.h"

using namespace couture;
using namespace couture::iga;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;

namespace {

constexpr double tolerance = 1e-10;

MatrixX random_matrix(int n_rows, int n_columns, unsigned seed) {
    std::mt19937 generator(seed);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    return MatrixX::NullaryExpr(n_rows, n_columns, [&]() { return uniform(generator); });
}

SolverOptions options_of(const std::string& name) {
    SolverOptions options;
    options.name = name;
    options.tolerance = tolerance;
    return options;
}

/// All but fast_diagonalization, which these matrices have no space for.
std::string any_solver() { return GENERATE("auto", "cholmod", "petsc", "umfpack"); }

/// Largest |b - A x| / |b| of the free unknowns, from the dense matrix.
double true_residual(const BlockMatrix& A, const std::vector<char>& is_fixed, const MatrixX& b,
                     const MatrixX& x) {
    MatrixX r = b - A * x;
    MatrixX free_b = b;
    for (std::size_t i = 0; i < is_fixed.size(); ++i) {
        if (is_fixed[i] != 0) {
            r.row(static_cast<int>(i)).setZero();
            free_b.row(static_cast<int>(i)).setZero();
        }
    }
    return (r.colwise().norm().array() / free_b.colwise().norm().array()).maxCoeff();
}

}  // namespace

TEST_CASE("LinearSolver: solves random positive definite systems", "[linalg]") {
    const std::string name = any_solver();
    const int block_size = GENERATE(1, 2, 3);
    const int n = 20 * block_size;
    const MatrixX factor = random_matrix(n, n, 5);
    const MatrixX dense = factor * factor.transpose() + MatrixX::Identity(n, n);
    const BlockMatrix A = to_blocks(dense, block_size);
    const MatrixX exact = random_matrix(n, 2, 9);
    const auto solver = make_linear_solver(options_of(name));
    solver->factorize({A, {}, {}});
    MatrixX x;
    const SolveReport report = solver->solve(dense * exact, x);
    // The condition of `dense` is about 100.
    CHECK((x - exact).norm() < 1e3 * tolerance * exact.norm());
    CHECK(report.residual <= tolerance);
    CHECK(report.solver == (name == "auto" ? "cholmod" : name));
    CHECK(report.note.empty());
}

TEST_CASE("LinearSolver: the report's residual is the true one, with fixed unknowns", "[linalg]") {
    const std::string name = any_solver();
    const int block_size = GENERATE(1, 2, 3);
    const BlockMatrix A = laplacian(8, block_size);
    std::vector<char> is_fixed(A.n_unknowns(), 0);
    for (int i = 0; i < A.n_unknowns(); i += 7) {
        is_fixed[i] = 1;
    }
    const MatrixX b = random_matrix(A.n_unknowns(), 3, 2);
    const auto solver = make_linear_solver(options_of(name));
    solver->factorize({A, is_fixed, {}});
    MatrixX x;
    const SolveReport report = solver->solve(b, x);
    for (int i = 0; i < A.n_unknowns(); i += 7) {
        CHECK(x.row(i).isZero(0.0));
    }
    const double residual = true_residual(A, is_fixed, b, x);
    CHECK(residual <= tolerance);
    CHECK(report.residual == Approx(residual).epsilon(0.01).margin(1e-17));
    CHECK(report.memory > 0);
}

TEST_CASE("LinearSolver: elasticity with its rigid motions as near null space", "[linalg]") {
    const std::string name = any_solver();
    const ElasticCube cube = elastic_cube(2, 5);
    const auto solver = make_linear_solver(options_of(name));
    solver->factorize({cube.matrix, cube.clamped, cube.rigid_motions});
    const MatrixX b = MatrixX::Ones(cube.matrix.n_unknowns(), 1);
    MatrixX x;
    const SolveReport report = solver->solve(b, x);
    CHECK(true_residual(cube.matrix, cube.clamped, b, x) <= tolerance);
    CHECK(report.iterations < 60);
}

TEST_CASE("LinearSolver: zero right-hand sides and fully fixed systems give zero", "[linalg]") {
    const std::string name = any_solver();
    const BlockMatrix A = laplacian(3, 2);
    const auto solver = make_linear_solver(options_of(name));
    MatrixX x;
    solver->factorize({A, {}, {}});
    MatrixX b = MatrixX::Zero(A.n_unknowns(), 2);
    CHECK(solver->solve(b, x).residual == 0.0);
    CHECK(x == b);
    b.col(1).setOnes();
    CHECK(solver->solve(b, x).residual <= tolerance);
    CHECK(x.col(0).isZero(0.0));
    solver->factorize({A, std::vector<char>(A.n_unknowns(), 1), {}});
    CHECK(solver->solve(b, x).residual == 0.0);
    CHECK(x.isZero(0.0));
}

TEST_CASE("LinearSolver: a second factorization replaces the first", "[linalg]") {
    const std::string name = any_solver();
    BlockMatrix A = laplacian(4, 1);
    const auto solver = make_linear_solver(options_of(name));
    const MatrixX b = random_matrix(A.n_unknowns(), 1, 8);
    MatrixX first;
    MatrixX second;
    solver->factorize({A, {}, {}});
    CHECK(solver->solve(b, first).residual <= tolerance);
    for (double& value : A.values) {
        value *= 4.0;
    }
    solver->factorize({A, {}, {}});
    CHECK(solver->solve(b, second).residual <= tolerance);
    CHECK((4.0 * second - first).norm() < 1e3 * tolerance * first.norm());
    std::vector<char> is_fixed(A.n_unknowns(), 0);
    is_fixed[3] = 1;
    solver->factorize({A, is_fixed, {}});
    CHECK(solver->solve(b, second).residual <= tolerance);
    CHECK(second.row(3).isZero(0.0));
}

TEST_CASE("LinearSolver: two runs give the same bits", "[linalg]") {
    const std::string name = any_solver();
    const ElasticCube cube = elastic_cube(2, 4);
    const MatrixX b = random_matrix(cube.matrix.n_unknowns(), 1, 4);
    MatrixX x[2];
    for (MatrixX& result : x) {
        const auto solver = make_linear_solver(options_of(name));
        solver->factorize({cube.matrix, cube.clamped, cube.rigid_motions});
        CHECK(solver->solve(b, result).residual <= tolerance);
    }
    CHECK(x[0] == x[1]);
}

TEST_CASE("LinearSolver: unconstrained rigid motions are counted", "[linalg]") {
    const std::string name = any_solver();
    const ElasticCube cube = elastic_cube(2, 3);
    const auto solver = make_linear_solver(options_of(name));
    std::vector<char> is_fixed(cube.matrix.n_unknowns(), 0);
    CHECK_THROWS_WITH(solver->factorize({cube.matrix, is_fixed, cube.rigid_motions}),
                      Contains("6 of 6 rigid-body motions are unconstrained"));
    // One point held: the three rotations about it remain.
    is_fixed[0] = is_fixed[1] = is_fixed[2] = 1;
    CHECK_THROWS_WITH(solver->factorize({cube.matrix, is_fixed, cube.rigid_motions}),
                      Contains("3 of 6 rigid-body motions are unconstrained"));
    MatrixX x;
    CHECK_THROWS_WITH(solver->solve(MatrixX::Zero(cube.matrix.n_unknowns(), 1), x),
                      Contains("before factorize succeeded"));
}

TEST_CASE("LinearSolver: a singular matrix is an error also without its null space", "[linalg]") {
    const std::string name = any_solver();
    const ElasticCube cube = elastic_cube(2, 4);
    const auto solver = make_linear_solver(options_of(name));
    MatrixX x;
    const auto run = [&] {
        solver->factorize({cube.matrix, {}, {}});
        static_cast<void>(solver->solve(random_matrix(cube.matrix.n_unknowns(), 1, 6), x));
    };
    CHECK_THROWS_WITH(run(), name == "petsc" ? Contains("may be singular") ||
                                                   Contains("not positive definite") ||
                                                   Contains("raise max_iterations")
                                             : Contains("singular: the pivot of unknown") ||
                                                   Contains("not positive definite: the pivot") ||
                                                   Contains("is singular: its pivots differ by") ||
                                                   Contains("the matrix is ill-conditioned"));
}

TEST_CASE("cholmod: an indefinite matrix is an error that names the unknown", "[linalg]") {
    MatrixX dense = 4.0 * MatrixX::Identity(12, 12);
    dense(7, 7) = -1.0;
    const BlockMatrix A = to_blocks(dense, 3);
    std::vector<char> is_fixed(12, 0);
    is_fixed[2] = 1;
    const auto solver = make_linear_solver(options_of(GENERATE("cholmod", "auto")));
    CHECK_THROWS_WITH(solver->factorize({A, is_fixed, {}}),
                      "cholmod: the matrix is not positive definite: the pivot of unknown 7 "
                      "(component 1 of block row 2) is not positive; check supports, material "
                      "parameters and folded elements");
}

TEST_CASE("LinearSolver: a residual above the tolerance is an error with its value", "[linalg]") {
    const std::string name = any_solver();
    const BlockMatrix A = laplacian(6, 1);
    SolverOptions options = options_of(name);
    options.tolerance = 1e-30;
    options.max_iterations = 2;
    const auto solver = make_linear_solver(options);
    solver->factorize({A, {}, {}});
    MatrixX x;
    CHECK_THROWS_WITH(solver->solve(random_matrix(A.n_unknowns(), 1, 1), x),
                      Contains("|b - A x| / |b| = ") && Contains("> 1e-30"));
}

TEST_CASE("LinearSolver: wrong input is named", "[linalg]") {
    const std::string name = any_solver();
    const auto solver = make_linear_solver(options_of(name));
    const BlockMatrix A = laplacian(2, 1);
    CHECK_THROWS_WITH(solver->factorize({A, {1, 0}, {}}),
                      Contains("2 flags of fixed unknowns for 8 unknowns"));
    CHECK_THROWS_WITH(solver->factorize({A, {}, MatrixX::Ones(5, 1)}),
                      Contains("the near null space has 5 rows for 8 unknowns"));
    BlockMatrix without_diagonal = A;
    without_diagonal.columns[0] = 1;
    CHECK_THROWS_WITH(solver->factorize({without_diagonal, {}, {}}),
                      Contains("block row 0 has no diagonal block"));
    solver->factorize({A, {}, {}});
    MatrixX x;
    CHECK_THROWS_WITH(solver->solve(MatrixX::Ones(7, 1), x),
                      Contains("the right-hand side has 7 rows; must be the 8 unknowns"));
    MatrixX b = MatrixX::Ones(8, 2);
    b(3, 1) = std::nan("");
    CHECK_THROWS_WITH(solver->solve(b, x),
                      Contains("right-hand side 1 is nan at unknown 3 (component 0 of block row "
                               "3); must be finite"));
}

TEST_CASE("make_linear_solver: an unknown name lists those there are", "[linalg]") {
    CHECK_THROWS_WITH(make_linear_solver(options_of("mumps")),
                      "linear solver: unknown name 'mumps'; there are auto, cholmod, "
                      "fast_diagonalization, matrix_free, petsc, umfpack");
    CHECK(linear_solver_names().front() == "auto");
}

TEST_CASE("cholmod: a factor beyond the memory limit is refused before it is computed",
          "[linalg]") {
    const BlockMatrix A = laplacian(10, 1);
    SolverOptions options = options_of("cholmod");
    options.memory_limit = 10000;
    const auto solver = make_linear_solver(options);
    CHECK_THROWS_WITH(solver->factorize({A, {}, {}}),
                      StartsWith("cholmod: the factor of 1000 unknowns has ") &&
                          Contains("the limit is 0.01 MB; use petsc or a coarser mesh"));
}

TEST_CASE("auto: falls back to petsc when the factor is too large, and says so", "[linalg]") {
    const BlockMatrix A = laplacian(10, 1);
    SolverOptions options = options_of("auto");
    options.memory_limit = 10000;
    const auto solver = make_linear_solver(options);
    solver->factorize({A, {}, {}});
    MatrixX x;
    const SolveReport report = solver->solve(MatrixX::Ones(1000, 1), x);
    CHECK(report.solver == "petsc");
    CHECK_THAT(report.note, StartsWith("fell back to petsc: cholmod: the factor of 1000 unknowns"));
}

TEST_CASE("petsc: unsymmetric matrices are solved, cholmod refuses them", "[linalg]") {
    MatrixX dense = random_matrix(30, 30, 3);
    dense.diagonal().array() += 10.0;
    const BlockMatrix A = to_blocks(dense, 3, false);
    const MatrixX exact = random_matrix(30, 1, 4);
    const auto solver = make_linear_solver(options_of(GENERATE("petsc", "auto")));
    solver->factorize({A, {}, {}});
    MatrixX x;
    CHECK(solver->solve(dense * exact, x).residual <= tolerance);
    CHECK((x - exact).norm() < 1e3 * tolerance * exact.norm());
    CHECK_THROWS_WITH(make_linear_solver(options_of("cholmod"))->factorize({A, {}, {}}),
                      "cholmod: the matrix is not stored as symmetric; use petsc");
}

TEST_CASE("petsc: options reach it, unread ones are errors", "[linalg]") {
    const BlockMatrix A = laplacian(6, 2);
    const MatrixX b = random_matrix(A.n_unknowns(), 1, 12);
    MatrixX x;
    SolverOptions options = options_of("petsc");
    options.petsc_options = "-ksp_type preonly -pc_type cholesky";
    const auto direct = make_linear_solver(options);
    direct->factorize({A, {}, {}});
    CHECK(direct->solve(b, x).iterations == 1);

    options.petsc_options = "-ksp_type gmres -pc_type jacobi";
    const auto gmres = make_linear_solver(options);
    gmres->factorize({A, {}, {}});
    CHECK(gmres->solve(b, x).residual <= tolerance);

    options.petsc_options = "-pc_typ jacobi -ksp_type cg";
    CHECK_THROWS_WITH(make_linear_solver(options)->factorize({A, {}, {}}),
                      StartsWith("petsc: nothing reads the option -pc_typ; check its spelling"));
    options.petsc_options = "-pc_type no_such_thing";
    CHECK_THROWS_AS(make_linear_solver(options)->factorize({A, {}, {}}), SolverError);
    CHECK_THROWS_WITH(make_linear_solver(options)->factorize({A, {}, {}}),
                      Contains("no_such_thing"));
}

TEST_CASE("cholmod: a residual that is rounding of A x is accepted and named", "[linalg]") {
    // A long chain of springs pulled at its end: |A| |x| = 4 n |b|, so that eps times it exceeds
    // the tolerance.
    constexpr int n = 100000;
    BlockMatrix A;
    A.n_rows = n;
    A.row_begin.push_back(0);
    for (int row = 0; row < n; ++row) {
        A.columns.push_back(row);
        A.values.push_back(row + 1 < n ? 2.0 / 3.0 : 1.0 / 3.0);
        if (row + 1 < n) {
            A.columns.push_back(row + 1);
            A.values.push_back(-1.0 / 3.0);
        }
        A.row_begin.push_back(static_cast<std::int64_t>(A.columns.size()));
    }
    MatrixX b = MatrixX::Zero(n, 1);
    b(n - 1, 0) = 0.1;
    MatrixX x;
    const auto solver = make_linear_solver(options_of("cholmod"));
    solver->factorize({A, {}, {}});
    const SolveReport report = solver->solve(b, x);
    CHECK(report.residual > tolerance);
    CHECK(report.residual < 1e-6);
    CHECK_THAT(report.note, StartsWith("the residual is the rounding of A x: |A| |x| is "));
    CHECK(x(n - 1, 0) == Approx(0.3 * n).epsilon(1e-6));
}

TEST_CASE("umfpack: an indefinite matrix is solved", "[linalg]") {
    MatrixX dense = 4.0 * MatrixX::Identity(12, 12);
    dense(7, 7) = -1.0;
    dense(2, 7) = dense(7, 2) = 3.0;
    const BlockMatrix A = to_blocks(dense, 3);
    const MatrixX exact = random_matrix(12, 2, 4);
    const auto solver = make_linear_solver(options_of("umfpack"));
    solver->factorize({A, {}, {}});
    MatrixX x;
    static_cast<void>(solver->solve(dense * exact, x));
    CHECK((x - exact).norm() < 1e-13);
}

TEST_CASE("umfpack: singular matrices and too little memory are named", "[linalg]") {
    MatrixX dense = MatrixX::Identity(6, 6);
    dense(4, 4) = 0.0;
    const BlockMatrix singular = to_blocks(dense, 3);
    CHECK_THROWS_WITH(make_linear_solver(options_of("umfpack"))->factorize({singular, {}, {}}),
                      "umfpack: the matrix of 6 unknowns can't be factorized: it is singular");
    const BlockMatrix A = laplacian(8, 1);
    SolverOptions options = options_of("umfpack");
    options.memory_limit = 1000;
    CHECK_THROWS_WITH(make_linear_solver(options)->factorize({A, {}, {}}),
                      StartsWith("umfpack: the factors of ") && Contains("the limit is 0.001 MB"));
}
