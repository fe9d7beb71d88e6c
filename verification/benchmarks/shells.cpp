#include "verification/benchmarks/shells.h"

#include <cmath>
#include <numbers>

#include "verification/problem_tools.h"

namespace couture::verification {

using namespace iga;

namespace {

/// Distance of a point from the shell's axis y.
double radius_of(const Vector3& x) { return std::hypot(x[0], x[2]); }

void scordelis_lo(Recorder& recorder) {
    constexpr double radius = 25.0;
    constexpr double thickness = 0.25;
    constexpr double half_angle = 40.0 * std::numbers::pi / 180.0;
    constexpr double weight_per_area = 90.0;
    const MultiPatch<3> roof = part<3>("scordelis_lo");
    Problem problem;
    problem.materials = {make_isotropic("solid", 4.32e8, 0.0)};
    problem.supports = {make_symmetry("crown"), make_symmetry("mid_span"),
                        make_support("diaphragm", 0.0, {}, 0.0)};
    BodyForce weight;
    weight.components = {constant(0.0), constant(0.0), constant(-weight_per_area / thickness)};
    problem.body_forces = {weight};
    const CaseResult<3> result = solve<3>(make_space<3>(roof, 4, {1, 24, 20}), problem);
    const auto sinking = [&](double r) {
        const Vector3 edge(r * std::sin(half_angle), 25.0, r * std::cos(half_angle));
        return -displacement_at<3>(result.displacement, edge)[2];
    };
    recorder.set_source("[ScordelisLo64]; converged solid");
    constexpr double bound = 1e-3;
    recorder.relative("free edge, middle surface", 0.3015, sinking(radius), bound);
    recorder.relative("free edge, inner surface", 0.2990, sinking(radius - thickness / 2), bound);
    recorder.relative("free edge, outer surface", 0.3039, sinking(radius + thickness / 2), bound);
    recorder.set_source("equilibrium");
    recorder.vanishing("load + reactions, over load", result.balance, 1e-10);
    recorder.set_source("exact NURBS");
    recorder.vanishing(
        "geometry error of the inner surface",
        geometry_error<3>(roof, "inner",
                          [](const Vector3& x) { return radius_of(x) - (radius - thickness / 2); }),
        1e-13);
}

/// One force on each of two opposite sides; an octant carries a quarter of one. Elements of at
/// least four thicknesses: below that the solid begins to see that the force has no area.
void pinched_cylinder(Recorder& recorder) {
    constexpr double radius = 300.0;
    constexpr double thickness = 3.0;
    const MultiPatch<3> octant = part<3>("pinched_cylinder");
    Problem problem;
    problem.materials = {make_isotropic("solid", 3e6, 0.3)};
    problem.supports = {make_symmetry("cut_x"), make_symmetry("cut_z"), make_symmetry("mid_span"),
                        make_support("diaphragm", 0.0, {}, 0.0)};
    PointLoad load;
    load.on = "load_point";
    load.force = Vector3(0.0, 0.0, -0.25);
    problem.point_loads = {load};
    const CaseResult<3> result = solve<3>(make_space<3>(octant, 4, {1, 24, 18}), problem);
    recorder.set_source("[MacNealHarder85], shell value");
    recorder.relative("deflection under the load", 1.82488e-5,
                      -displacement_at<3>(result.displacement, {0.0, 300.0, radius})[2], 2e-2);
    recorder.set_source("exact NURBS");
    recorder.vanishing(
        "geometry error of the inner surface",
        geometry_error<3>(octant, "inner",
                          [](const Vector3& x) { return radius_of(x) - (radius - thickness / 2); }),
        1e-12);
}

}  // namespace

std::vector<Case> shell_cases() {
    return {{"Scordelis-Lo roof, solid", false, scordelis_lo},
            {"pinched cylinder, solid", false, pinched_cylinder}};
}

}  // namespace couture::verification
