#include "verification/benchmarks/cook.h"

#include <cmath>

#include "verification/problem_tools.h"

namespace couture::verification {

using namespace iga;

namespace {

constexpr double height_of_loaded_side = 16.0;

Traction shear(double resultant) {
    Traction load;
    load.on = "loaded";
    load.components = {constant(0.0), constant(resultant / height_of_loaded_side), constant(0.0)};
    return load;
}

/// `n_elements` per direction that shrink by `ratio` from one to the next towards the clamped side
/// and its two corners, the upper of which is singular.
SpacePtr<2> graded_space(const MultiPatch<2>& membrane, int degree, int n_elements, double ratio) {
    std::vector<double> one_end = {0.0};
    for (int i = 1; i <= n_elements; ++i) {
        one_end.push_back(std::pow(ratio, n_elements - i));
    }
    std::vector<double> both_ends;
    for (const double x : one_end) {
        both_ends.push_back(0.5 * x);
    }
    for (int i = n_elements - 1; i >= 0; --i) {
        both_ends.push_back(1.0 - 0.5 * one_end[i]);
    }
    const auto knots = [degree](const std::vector<double>& breakpoints) {
        std::vector<double> all(degree, 0.0);
        all.insert(all.end(), breakpoints.begin(), breakpoints.end());
        all.insert(all.end(), degree, 1.0);
        return KnotVector(degree, all);
    };
    return std::make_shared<const Space<2>>(
        membrane, std::vector<TensorSpace<2>>{{{knots(one_end), knots(both_ends)}}});
}

void compare(Recorder& recorder, const SpacePtr<2>& space, const Problem& problem, double middle,
             double corner, double bound) {
    const Field<2> u = solve<2>(space, problem).displacement;
    recorder.relative("deflection at (48, 52)", middle, displacement_at<2>(u, {48.0, 52.0, 0.0})[1],
                      bound);
    recorder.relative("deflection at (48, 60)", corner, displacement_at<2>(u, {48.0, 60.0, 0.0})[1],
                      bound);
}

void plane_stress(Recorder& recorder) {
    recorder.set_source("[Cook74]; converged by two codes");
    Problem problem;
    problem.kinematics = Kinematics::plane_stress;
    problem.materials = {isotropic(1.0, 1.0 / 3.0)};
    problem.supports = {hold("clamped", 0.0, 0.0)};
    problem.tractions = {shear(1.0)};
    compare(recorder, graded_space(part<2>("cook"), 4, 8, 0.4), problem, 23.9675, 25.189, 1e-4);
}

/// Displacements alone: high degree instead of a mixed method keeps locking away.
void nearly_incompressible(Recorder& recorder, double lambda, double middle, double corner,
                           double bound) {
    recorder.set_source("[Cook74]; converged, Taylor-Hood p = 4..8");
    constexpr double shear_modulus = 0.375;
    const double E =
        shear_modulus * (3.0 * lambda + 2.0 * shear_modulus) / (lambda + shear_modulus);
    const double nu = lambda / (2.0 * (lambda + shear_modulus));
    Problem problem;
    problem.kinematics = Kinematics::plane_strain;
    problem.materials = {isotropic(E, nu)};
    problem.supports = {hold("clamped", 0.0, 0.0)};
    problem.tractions = {shear(1.0)};
    compare(recorder, graded_space(part<2>("cook"), 8, 8, 0.4), problem, middle, corner, bound);
}

}  // namespace

std::vector<Case> cook_cases() {
    return {{"Cook, plane stress", false, plane_stress},
            {"Cook, nu = 0.4999", false,
             [](Recorder& r) {
                 constexpr double nu = 0.4999;
                 nearly_incompressible(r, 2.0 * 0.375 * nu / (1.0 - 2.0 * nu), 16.456, 17.271,
                                       1e-3);
             }},
            {"Cook, lambda / G = 2e4", false,
             [](Recorder& r) { nearly_incompressible(r, 0.75e4, 16.4538, 17.268, 1e-3); }},
            {"Cook, lambda / G = 2e7", false,
             [](Recorder& r) { nearly_incompressible(r, 0.75e7, 16.4530, 17.267, 1e-3); }}};
}

}  // namespace couture::verification
