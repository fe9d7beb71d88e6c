#include "verification/benchmarks/cook.h"

#include <algorithm>
#include <cmath>

#include "iga/core/error.h"
#include "verification/problem_tools.h"

namespace couture::verification {

using namespace iga;

namespace {

constexpr double height_of_loaded_side = 16.0;
/// Of the nearly incompressible cases.
constexpr double shear_modulus = 0.375;

Traction shear(double resultant) {
    Traction load;
    load.on = "loaded";
    load.components = {constant(0.0), constant(resultant / height_of_loaded_side), constant(0.0)};
    return load;
}

/// Breakpoints of `n_elements` equal elements of [0, 1], the outermost of which are split
/// `n_levels` times, each time near the end, where the solution is singular.
std::vector<double> graded(int n_elements, int n_levels) {
    constexpr double ratio = 0.15;
    std::vector<double> breakpoints;
    for (int i = 0; i <= n_elements; ++i) {
        breakpoints.push_back(i / static_cast<double>(n_elements));
    }
    double size = breakpoints[1];
    for (int level = 0; level < n_levels; ++level) {
        size *= ratio;
        breakpoints.push_back(size);
        breakpoints.push_back(1.0 - size);
    }
    std::sort(breakpoints.begin(), breakpoints.end());
    return breakpoints;
}

/// Elements that shrink towards all sides: the clamped corner above and the loaded one above are
/// singular.
SpacePtr<2> graded_space(int degree, int n_elements, int n_levels) {
    const std::vector<double> breakpoints = graded(n_elements, n_levels);
    std::vector<double> knots(degree, 0.0);
    knots.insert(knots.end(), breakpoints.begin(), breakpoints.end());
    knots.insert(knots.end(), degree, 1.0);
    const KnotVector direction(degree, knots);
    return std::make_shared<const Space<2>>(part<2>("cook"),
                                            std::vector<TensorSpace<2>>{{{direction, direction}}});
}

void compare(Recorder& recorder, const SpacePtr<2>& space, const Problem& problem, double middle,
             double corner, double bound, const LinearStaticOptions& options = {}) {
    const Field<2> u = solve_linear_static<2>(space, problem, options).cases.at(0).displacement;
    recorder.relative("deflection at (48, 52)", middle, displacement_at<2>(u, {48.0, 52.0, 0.0})[1],
                      bound);
    recorder.relative("deflection at (48, 60)", corner, displacement_at<2>(u, {48.0, 60.0, 0.0})[1],
                      bound);
}

void plane_stress(Recorder& recorder) {
    recorder.set_source("[Cook74]; converged value");
    Problem problem;
    problem.kinematics = Kinematics::plane_stress;
    problem.materials = {make_isotropic("solid", 1.0, 1.0 / 3.0)};
    problem.supports = {make_support("clamped", 0.0, 0.0)};
    problem.tractions = {shear(1.0)};
    compare(recorder, graded_space(8, 16, 3), problem, 23.9675, 25.189, 1e-4);
}

/// Displacements alone: high degree instead of a mixed method keeps most of the locking away. What
/// is left of it, not the reference, sets the bounds.
void nearly_incompressible(Recorder& recorder, double lambda, const SpacePtr<2>& space,
                           double middle, double corner, double bound,
                           const LinearStaticOptions& options = {}) {
    recorder.set_source("[Cook74]; converged, Taylor-Hood p = 4..8");
    const double E =
        shear_modulus * (3.0 * lambda + 2.0 * shear_modulus) / (lambda + shear_modulus);
    const double nu = lambda / (2.0 * (lambda + shear_modulus));
    Problem problem;
    problem.kinematics = Kinematics::plane_strain;
    problem.materials = {make_isotropic("solid", E, nu)};
    problem.supports = {make_support("clamped", 0.0, 0.0)};
    problem.tractions = {shear(1.0)};
    compare(recorder, space, problem, middle, corner, bound, options);
}

void nu_04999(Recorder& recorder) {
    constexpr double nu = 0.4999;
    nearly_incompressible(recorder, 2.0 * shear_modulus * nu / (1.0 - 2.0 * nu),
                          graded_space(8, 24, 1), 16.456, 17.271, 2e-3);
}

void lambda_over_G_2e4(Recorder& recorder) {
    nearly_incompressible(recorder, 0.75e4, graded_space(8, 24, 1), 16.4538, 17.268, 2e-3);
}

void lambda_over_G_2e7(Recorder& recorder) {
    // The residual stays at 1.5e-5, above the default tolerance.
    LinearStaticOptions options;
    options.solver.tolerance = 1e-4;
    nearly_incompressible(recorder, 0.75e7, graded_space(8, 32, 0), 16.4530, 17.267, 5e-3, options);
}

/// A mesh of `graded_space` and how far from the converged value its deflections may be.
struct Mesh {
    int degree;
    int n_elements;
    int n_levels;
    double bound;
};

/// Finite strain in plane strain: a dead shear of 1/16 per undeformed area turns the loaded side by
/// more than half a radian.
void finite_strain(Recorder& recorder, double bulk_modulus, double middle, double corner,
                   const std::vector<Mesh>& meshes) {
    recorder.set_source("[Cook74] with neo-Hookean material; converged value");
    Problem problem = neo_hookean_problem(Kinematics::plane_strain, shear_modulus, bulk_modulus);
    problem.supports = {make_support("clamped", 0.0, 0.0)};
    problem.tractions = {shear(1.0)};
    for (const Mesh& mesh : meshes) {
        const SpacePtr<2> space = graded_space(mesh.degree, mesh.n_elements, mesh.n_levels);
        const Field<2> u{space, run_to_end<2>(space, problem).state.displacement};
        const std::string where = fmt::format("p={}, n={}", mesh.degree, mesh.n_elements);
        recorder.relative("v(48, 52), " + where, middle,
                          displacement_at<2>(u, {48.0, 52.0, 0.0})[1], mesh.bound);
        recorder.relative("v(48, 60), " + where, corner,
                          displacement_at<2>(u, {48.0, 60.0, 0.0})[1], mesh.bound);
    }
}

void finite_compressible(Recorder& recorder) {
    finite_strain(recorder, 1.0, 15.593, 14.4975,
                  {{1, 64, 0, 5e-3}, {2, 32, 0, 1e-3}, {3, 32, 0, 5e-4}});
}

/// Plain displacements would lock: the change of volume is projected, the default for this ratio.
void finite_nearly_incompressible(Recorder& recorder) {
    finite_strain(recorder, 375.0, 13.174, 12.516,
                  {{1, 32, 0, 1e-2}, {2, 32, 0, 5e-3}, {3, 16, 0, 5e-3}});
}

}  // namespace

std::vector<Case> cook_cases() {
    return {{"Cook, plane stress", false, plane_stress},
            {"Cook, nu = 0.4999", false, nu_04999},
            {"Cook, lambda / G = 2e4", false, lambda_over_G_2e4},
            {"Cook, lambda / G = 2e7", false, lambda_over_G_2e7},
            {"Cook, finite strain, nu = 1/3", false, finite_compressible},
            {"Cook, finite strain, kappa / mu = 1000", false, finite_nearly_incompressible}};
}

}  // namespace couture::verification
