#include "verification/benchmarks/beams.h"

#include <fmt/format.h>

#include "verification/problem_tools.h"

namespace couture::verification {

using namespace iga;

namespace {

constexpr double length = 10.0;
constexpr double height = 1.0;
constexpr double force = 2.0;
constexpr double youngs_modulus = 1000.0;
constexpr double second_moment = height * height * height / 12.0;
constexpr double EI = youngs_modulus * second_moment;

/// Displacement of the cantilever of unit thickness under a force -`force` along y at x = length,
/// spread as the parabola of beam theory; y from the axis.
Vector2 exact_displacement(double x, double y, double nu) {
    const double h2 = height * height / 4.0;
    return force / (6.0 * EI) *
           Vector2(y * ((6.0 * length - 3.0 * x) * x + (2.0 + nu) * (y * y - h2)),
                   -(3.0 * nu * y * y * (length - x) + (4.0 + 5.0 * nu) * h2 * x +
                     (3.0 * length - x) * x * x));
}

/// The solution is cubic: degree 3 must reproduce it.
void plane_stress_cantilever(Recorder& recorder) {
    recorder.set_source("[TimoshenkoGoodier70] Art. 21");
    constexpr double nu = 0.3;
    const MultiPatch<2> beam = part<2>("rectangle", {{"length_x", length}, {"length_y", height}});
    Problem problem;
    problem.kinematics = Kinematics::plane_stress;
    problem.materials = {make_isotropic("solid", youngs_modulus, nu)};
    Support root;
    root.on = "x_low";
    for (int a = 0; a < 2; ++a) {
        root.components[a] = [a](const Vector3& x, double) {
            return exact_displacement(0.0, x[1] - height / 2, nu)[a];
        };
    }
    problem.supports = {root};
    Traction tip;
    tip.on = "x_high";
    tip.components = {constant(0.0),
                      [](const Vector3& x, double) {
                          const double y = x[1] - height / 2;
                          return -force / (2.0 * second_moment) * (height * height / 4.0 - y * y);
                      },
                      constant(0.0)};
    problem.tractions = {tip};
    const CaseResult<2> result = solve<2>(make_space<2>(beam, 3, {4, 1}), problem);
    // The slender beam's condition number times rounding.
    constexpr double bound = 1e-9;
    recorder.relative("tip deflection, p=3", exact_displacement(length, 0.0, nu)[1],
                      displacement_at<2>(result.displacement, {length, height / 2, 0.0})[1], bound);
    recorder.relative("stress_xx at the root", force * length * height / 2 / second_moment,
                      stress_at<2>(problem, result.displacement, {0.0, height, 0.0})[0], bound);
}

/// Clamped solid against P L^3 / (3 E I) + P L / (k G A).
void clamped_solid(Recorder& recorder) {
    const MultiPatch<3> beam = part<3>("cantilever", {{"length", length}, {"height", height}});
    recorder.set_source("Timoshenko beam, k of [Cowper66]");
    for (const double nu : {0.0, 0.3}) {
        Problem problem;
        problem.materials = {make_isotropic("solid", youngs_modulus, nu)};
        problem.supports = {make_support("clamped", 0.0, 0.0, 0.0)};
        Resultant tip;
        tip.on = "tip";
        tip.force = Vector3(0.0, 0.0, -force);
        problem.resultants = {tip};
        const CaseResult<3> result = solve<3>(make_space<3>(beam, 3, {16, 2, 3}), problem);
        const double G = youngs_modulus / (2.0 * (1.0 + nu));
        const double k = 10.0 * (1.0 + nu) / (12.0 + 11.0 * nu);
        const double expected =
            force * length * length * length / (3.0 * EI) + force * length / (k * G * height);
        // Beam theory knows no clamped lateral contraction.
        const double bound = nu == 0.0 ? 1e-3 : 1e-2;
        const VectorX u = displacement_at<3>(result.displacement, {length, 0.5, height / 2});
        recorder.relative(fmt::format("tip deflection, nu={}", nu), expected, -u[2], bound);
    }
}

}  // namespace

std::vector<Case> beam_cases() {
    return {{"cantilever, plane stress", false, plane_stress_cantilever},
            {"cantilever, solid", false, clamped_solid}};
}

}  // namespace couture::verification
