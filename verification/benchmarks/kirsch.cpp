#include "verification/benchmarks/kirsch.h"

#include <cmath>

#include "verification/problem_tools.h"

namespace couture::verification {

using namespace iga;

namespace {

constexpr double hole_radius = 1.0;
constexpr double tension = 10.0;

/// Stresses xx, yy, xy of the infinite plate.
Vector3 exact_stress(const Vector3& x) {
    const double q = hole_radius * hole_radius / x.squaredNorm();
    const double t = std::atan2(x[1], x[0]);
    const double c2 = std::cos(2.0 * t);
    const double c4 = std::cos(4.0 * t);
    const double s2 = std::sin(2.0 * t);
    const double s4 = std::sin(4.0 * t);
    return tension * Vector3(1.0 - q * (1.5 * c2 + c4) + 1.5 * q * q * c4,
                             -(q * (0.5 * c2 - c4) + 1.5 * q * q * c4),
                             -(q * (0.5 * s2 + s4) - 1.5 * q * q * s4));
}

/// The exact traction on a side with its normal along an axis.
Traction exact_traction(const std::string& on, int axis) {
    Traction load;
    load.on = on;
    load.components = {
        [axis](const Vector3& x, double) { return exact_stress(x)[axis == 0 ? 0 : 2]; },
        [axis](const Vector3& x, double) { return exact_stress(x)[axis == 0 ? 2 : 1]; },
        constant(0.0)};
    return load;
}

void plate_with_hole(Recorder& recorder) {
    recorder.set_source("[Kirsch1898], closed form");
    const MultiPatch<2> plate = part<2>("plate_with_hole");
    Problem problem;
    problem.kinematics = Kinematics::plane_stress;
    problem.materials = {make_isotropic("solid", 210e3, 0.3)};
    problem.supports = {make_symmetry("cut_x"), make_symmetry("cut_y")};
    problem.tractions = {exact_traction("x_high", 0), exact_traction("y_high", 1)};
    const CaseResult<2> result = solve<2>(make_space<2>(plate, 5, {16, 10}), problem);

    constexpr double bound = 1e-3;
    const auto stress = [&](double x, double y) {
        return stress_at<2>(problem, result.displacement, Vector3(x, y, 0.0));
    };
    recorder.relative("stress_xx at the top of the hole", 3.0 * tension, stress(0.0, 1.0)[0],
                      bound);
    recorder.relative("stress_yy at the side of the hole", -tension, stress(1.0, 0.0)[1], bound);
    const Vector3 inside(2.0, 1.3, 0.0);
    recorder.relative("stress_xy at (2, 1.3)", exact_stress(inside)[2], stress(2.0, 1.3)[5], bound);
    recorder.vanishing(
        "geometry error of the hole",
        geometry_error<2>(plate, "hole", [](const Vector3& x) { return x.norm() - hole_radius; }),
        1e-14);
}

}  // namespace

std::vector<Case> kirsch_cases() { return {{"plate with a hole", false, plate_with_hole}}; }

}  // namespace couture::verification
