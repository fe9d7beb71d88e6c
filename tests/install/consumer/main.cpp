// A quarter ring, refined, evaluated, written and read, and solved under internal pressure by a
// program outside of Couture's tree that is compiled for any processor: matrices and their memory
// go both ways across the libraries' border, and every library below them is linked.
#include <cmath>
#include <cstdio>
#include <exception>
#include <string>

#include "iga/solve/linear_static.h"
#include "iga/spline/refine.h"
#include "iga/spline/shapes.h"
#include "io/spline_file.h"
#include "io/vtk_writer.h"

namespace {

using namespace couture;

bool is_near(const char* what, double value, double expected, double tolerance = 1e-12) {
    std::printf("%-32s %.12g (expected %.12g)\n", what, value, expected);
    return std::abs(value - expected) < tolerance * std::abs(expected);
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

// Displacement of the ring's inner edge under internal pressure, plane strain.
double displacement_under_pressure(const iga::Surface& ring, const std::string& solver) {
    iga::MultiPatch<2> part;
    part.patches = {ring};
    part.boundary_sets = {{"inner", {iga::make_side<2>(0, 0)}},
                          {"cuts", {iga::make_side<2>(0, 2), iga::make_side<2>(0, 3)}}};

    iga::Problem problem;
    problem.kinematics = iga::Kinematics::plane_strain;
    problem.materials = {iga::make_isotropic("steel", 200.0, 0.3)};
    problem.supports = {iga::make_symmetry("cuts")};
    problem.pressures = {iga::make_pressure("inner", 1.0)};
    iga::LinearStaticOptions options;
    options.solver.name = solver;
    options.solver.tolerance = 1e-12;
    const auto space = std::make_shared<const iga::Space<2>>(part);
    const auto result = iga::solve_linear_static<2>(space, problem, options);
    std::printf("%s: %ld unknowns, %d iterations\n", result.solver.solver.c_str(),
                static_cast<long>(result.n_unknowns), result.solver.iterations);
    return result.cases[0].displacement.value(0, Vector2(0.0, 0.3)).norm();
}

// The closed form of Lame for radii 1 and 2, E = 200, nu = 0.3, unit pressure.
double lame_displacement() {
    constexpr double E = 200.0, nu = 0.3, a = 1.0, b = 2.0;
    return (1.0 + nu) / E * a * a / (b * b - a * a) * ((1.0 - 2.0 * nu) * a + b * b / a);
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
    const double expected = lame_displacement();
    for (const std::string solver : {"cholmod", "petsc"}) {
        is_good &= is_near(("ring under pressure by " + solver).c_str(),
                           displacement_under_pressure(ring, solver), expected, 1e-6);
    }
    return is_good ? 0 : 1;
} catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}
