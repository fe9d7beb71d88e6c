#include "verification/benchmarks/nafems.h"

#include "verification/problem_tools.h"

namespace couture::verification {

using namespace iga;

namespace {

/// Lengths in m, stresses in MPa.
constexpr double youngs_modulus = 210e3;
constexpr double poissons_ratio = 0.3;
constexpr double rounding = 1e-13;

/// 0 on the ellipse with these half axes.
std::function<double(const Vector3&)> ellipse(double a, double b) {
    return [a, b](const Vector3& x) { return x[0] * x[0] / (a * a) + x[1] * x[1] / (b * b) - 1.0; };
}

void le1(Recorder& recorder) {
    recorder.set_source("[NAFEMS90] LE1");
    const MultiPatch<2> membrane = part<2>("le1_membrane");
    Problem problem;
    problem.kinematics = Kinematics::plane_stress;
    problem.thickness = 0.1;
    problem.materials = {make_isotropic("solid", youngs_modulus, poissons_ratio)};
    problem.supports = {make_symmetry("ab"), make_symmetry("cd")};
    problem.pressures = {make_pressure("bc", -10.0)};
    const CaseResult<2> result = solve<2>(make_space<2>(membrane, 4, 12), problem);
    recorder.relative("stress_yy at D", 92.7,
                      stress_at<2>(problem, result.displacement, {2.0, 0.0, 0.0})[1], 1e-3);
    recorder.vanishing("geometry error inside",
                       geometry_error<2>(membrane, "ad", ellipse(2.0, 1.0)), rounding);
    recorder.vanishing("geometry error outside",
                       geometry_error<2>(membrane, "bc", ellipse(3.25, 2.75)), rounding);
}

void le10(Recorder& recorder, int degree) {
    recorder.set_source("[NAFEMS90] LE10");
    const MultiPatch<3> plate = part<3>("le10_plate");
    Problem problem;
    problem.materials = {make_isotropic("solid", youngs_modulus, poissons_ratio)};
    problem.supports = {make_symmetry("dcdc"), make_symmetry("abab"),
                        make_support("bcbc", 0.0, 0.0), make_support("mid_line", {}, {}, 0.0)};
    problem.pressures = {make_pressure("top", 1.0)};
    const CaseResult<3> result = solve<3>(make_space<3>(plate, degree, {16, 12, 4}), problem);
    recorder.relative("stress_yy at D on top", -5.38,
                      stress_at<3>(problem, result.displacement, {2.0, 0.0, 0.6})[1], 5e-3);
    recorder.vanishing("geometry error inside", geometry_error<3>(plate, "adad", ellipse(2.0, 1.0)),
                       rounding);
    recorder.vanishing("geometry error outside",
                       geometry_error<3>(plate, "bcbc", ellipse(3.25, 2.75)), rounding);
}

}  // namespace

std::vector<Case> nafems_cases() {
    return {{"NAFEMS LE1", false, le1},
            {"NAFEMS LE10", false, [](Recorder& r) { le10(r, 3); }},
            {"NAFEMS LE10, degree 4", true, [](Recorder& r) { le10(r, 4); }}};
}

}  // namespace couture::verification
