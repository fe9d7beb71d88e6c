// A quarter ring, refined, evaluated, written and read, and a small system solved, by a program
// outside of Couture's tree that is compiled for any processor: matrices and their memory go both
// ways across the libraries' border, and every library below them is linked.
#include <cmath>
#include <cstdio>
#include <exception>

#include "iga/linalg/sparse_solver.h"
#include "iga/spline/refine.h"
#include "iga/spline/shapes.h"
#include "io/spline_file.h"
#include "io/vtk_writer.h"

namespace {

using namespace couture;

bool is_near(const char* what, double value, double expected) {
    std::printf("%-32s %.12g (expected %.12g)\n", what, value, expected);
    return std::abs(value - expected) < 1e-12;
}

iga::Surface make_fine_ring() {
    const iga::Surface ring = iga::make_quarter_annulus(1.0, 2.0);
    // Ours, moved into the library, copied there and back, freed here.
    MatrixX rows = ring.homogeneous();
    rows *= 2.0;
    const iga::Surface same = iga::Surface::from_homogeneous(ring.space(), rows, true);
    return iga::refine<2>(same,
                          {iga::refine(same.knots(0), 3, 4), iga::refine(same.knots(1), 3, 4)});
}

// A chain of n springs between two walls under unit loads: x_i = (i + 1) (n - i) / 2.
double middle_of_chain(const char* solver_name) {
    constexpr int n = 9;
    iga::BlockMatrix A;
    A.n_rows = n;
    A.row_begin = {0};
    A.values.resize(2 * n - 1);
    for (int i = 0; i < n; ++i) {
        A.values[A.columns.size()] = 2.0;
        A.columns.push_back(i);
        if (i + 1 < n) {
            A.values[A.columns.size()] = -1.0;
            A.columns.push_back(i + 1);
        }
        A.row_begin.push_back(A.n_blocks());
    }
    iga::SolverOptions options;
    options.name = solver_name;
    options.tolerance = 1e-13;
    const auto solver = iga::make_linear_solver(options);
    solver->factorize({A, {}, {}});
    MatrixX x;
    const iga::SolveReport report = solver->solve(MatrixX::Ones(n, 1), x);
    std::printf("%s: %d iterations\n", report.solver.c_str(), report.iterations);
    return x(n / 2, 0);
}

}  // namespace

int main() try {
    const iga::Surface ring = make_fine_ring();
    iga::MultiPatch<2> multipatch;
    multipatch.patches.push_back(ring);
    io::write_vtu<2>("ring.vtu", iga::Space<2>(multipatch), {});
    io::write_splines("ring.xml", multipatch);
    const io::SplineFile file = io::read_splines("ring.xml");
    const iga::Surface read = std::get<iga::MultiPatch<2>>(file.multipatch).patches.at(0);

    bool is_good = true;
    for (const double eta : {0.0, 0.3, 1.0}) {
        is_good &= is_near("radius at half thickness", read.point(Vector2(0.5, eta)).norm(), 1.5);
    }
    const MatrixX J = read.jacobian(Vector2(0.0, 0.0));
    is_good &= is_near("radial stretch at the corner", J.col(0).norm(), 1.0);
    is_good &= is_near("middle of a chain by CHOLMOD", middle_of_chain("cholmod"), 12.5);
    is_good &= is_near("middle of a chain by PETSc", middle_of_chain("petsc"), 12.5);
    return is_good ? 0 : 1;
} catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}
