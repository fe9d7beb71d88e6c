#include "verification/benchmarks/lame.h"

#include <cmath>
#include <numbers>

#include "iga/spline/shapes.h"
#include "verification/problem_tools.h"

namespace couture::verification {

using namespace iga;

namespace {

constexpr double inner_radius = 1.0;
constexpr double outer_radius = 2.0;
constexpr double internal_pressure = 1.0;
constexpr double youngs_modulus = 1000.0;
constexpr double poissons_ratio = 0.3;

/// Radial displacement and hoop stress at a radius.
struct Radial {
    double displacement;
    double hoop_stress;
};

/// Plane strain: stress = A -+ B / r^2, u_r = (1 + nu) / E [(1 - 2 nu) A r + B / r].
Radial thick_cylinder(double r) {
    const double a2 = inner_radius * inner_radius;
    const double b2 = outer_radius * outer_radius;
    const double A = internal_pressure * a2 / (b2 - a2);
    const double B = A * b2;
    const double nu = poissons_ratio;
    return {(1.0 + nu) / youngs_modulus * ((1.0 - 2.0 * nu) * A * r + B / r), A + B / (r * r)};
}

/// u_r = 1 / E [(1 - 2 nu) A r + (1 + nu) B / (2 r^2)], hoop stress = A + B / (2 r^3).
Radial hollow_sphere(double r) {
    const double a3 = std::pow(inner_radius, 3);
    const double b3 = std::pow(outer_radius, 3);
    const double A = internal_pressure * a3 / (b3 - a3);
    const double B = A * b3;
    const double nu = poissons_ratio;
    return {((1.0 - 2.0 * nu) * A * r + (1.0 + nu) * B / (2.0 * r * r)) / youngs_modulus,
            A + B / (2.0 * r * r * r)};
}

Problem under_pressure(Kinematics kinematics) {
    Problem problem;
    problem.kinematics = kinematics;
    problem.materials = {make_isotropic("solid", youngs_modulus, poissons_ratio)};
    problem.pressures = {make_pressure("inner", internal_pressure)};
    return problem;
}

constexpr double displacement_bound = 1e-6;
constexpr double stress_bound = 1e-3;
constexpr double balance_bound = 1e-10;

/// Displacement along x and stress `hoop` (Voigt) at the inner and outer point on the x axis.
template <int d>
void compare(Recorder& recorder, const SpacePtr<d>& space, const Problem& problem,
             const std::function<Radial(double)>& exact, int hoop) {
    const CaseResult<d> result = solve<d>(space, problem);
    for (const double r : {inner_radius, outer_radius}) {
        const std::string where = r == inner_radius ? "inside" : "outside";
        const Vector3 x(r, 0.0, 0.0);
        recorder.relative("widening " + where, exact(r).displacement,
                          displacement_at<d>(result.displacement, x)[0], displacement_bound);
        recorder.relative("hoop stress " + where, exact(r).hoop_stress,
                          stress_at<d>(problem, result.displacement, x)[hoop], stress_bound);
    }
    recorder.vanishing("load + reactions, over load", result.balance, balance_bound);
}

/// How far the inner and outer sides are from their radii.
template <int d>
void compare_shape(Recorder& recorder, const MultiPatch<d>& geometry,
                   const std::function<double(const Vector3&)>& radius) {
    constexpr double rounding = 1e-14;
    recorder.vanishing(
        "geometry error inside",
        geometry_error<d>(geometry, "inner",
                          [&](const Vector3& x) { return radius(x) - inner_radius; }),
        rounding);
    recorder.vanishing(
        "geometry error outside",
        geometry_error<d>(geometry, "outer",
                          [&](const Vector3& x) { return radius(x) - outer_radius; }),
        rounding);
}

double distance_from_centre(const Vector3& x) { return x.norm(); }

constexpr const char* source = "[Lame1852], closed form";

void thick_cylinder_plane_strain(Recorder& recorder) {
    recorder.set_source(source);
    const MultiPatch<2> ring = part<2>("thick_cylinder");
    Problem problem = under_pressure(Kinematics::plane_strain);
    problem.supports = {make_symmetry("cut_x"), make_symmetry("cut_y")};
    compare<2>(recorder, make_space<2>(ring, 4, {8, 4}), problem, thick_cylinder, 1);
    compare_shape<2>(recorder, ring, distance_from_centre);
}

void thick_cylinder_solid(Recorder& recorder) {
    recorder.set_source(source);
    const MultiPatch<3> ring = part<3>("thick_cylinder_3d");
    Problem problem = under_pressure(Kinematics::solid);
    problem.supports = {make_symmetry("cut_x"), make_symmetry("cut_y"), make_symmetry("z_low"),
                        make_symmetry("z_high")};
    compare<3>(recorder, make_space<3>(ring, 4, {8, 4, 1}), problem, thick_cylinder, 1);
    compare_shape<3>(recorder, ring, [](const Vector3& x) { return x.template head<2>().norm(); });
}

void thick_cylinder_axisymmetric(Recorder& recorder) {
    recorder.set_source(source);
    MatrixX corners(4, 2);
    corners << inner_radius, 0.0, outer_radius, 0.0, inner_radius, 0.5, outer_radius, 0.5;
    MultiPatch<2> strip;
    strip.patches = {make_multilinear<2>(corners)};
    strip.boundary_sets = {{"inner", {make_side<2>(0, 0)}},
                           {"ends", {make_side<2>(0, 2), make_side<2>(0, 3)}}};
    Problem problem = under_pressure(Kinematics::axisymmetric);
    problem.supports = {make_support("ends", {}, 0.0)};
    compare<2>(recorder, make_space<2>(strip, 4, {8, 1}), problem, thick_cylinder, 2);
}

void hollow_sphere_solid(Recorder& recorder) {
    recorder.set_source(source);
    const MultiPatch<3> sphere = part<3>("hollow_sphere");
    Problem problem = under_pressure(Kinematics::solid);
    problem.supports = {make_symmetry("cut_x"), make_symmetry("cut_y"), make_symmetry("cut_z")};
    compare<3>(recorder, make_space<3>(sphere, 4, {8, 4, 4}), problem, hollow_sphere, 1);
    compare_shape<3>(recorder, sphere, distance_from_centre);
}

void hollow_sphere_axisymmetric(Recorder& recorder) {
    recorder.set_source(source);
    const MultiPatch<2> meridian = part<2>("half_annulus");
    Problem problem = under_pressure(Kinematics::axisymmetric);
    // On the axis no point moves across it; the mean plane y = 0 is the patches' common side.
    problem.supports = {make_support("axis", 0.0, {})};
    MultiPatch<2> held = meridian;
    const Interface<2>& equator = held.interfaces.at(0);
    held.boundary_sets["equator"] = {make_side<2>(equator.first_patch, equator.first_side)};
    problem.supports.push_back(make_support("equator", {}, 0.0));
    compare<2>(recorder, make_space<2>(held, 4, {8, 4}), problem, hollow_sphere, 2);
    compare_shape<2>(recorder, meridian, distance_from_centre);
}

}  // namespace

std::vector<Case> lame_cases() {
    return {{"thick cylinder, plane strain", false, thick_cylinder_plane_strain},
            {"thick cylinder, solid", false, thick_cylinder_solid},
            {"thick cylinder, axisymmetric", false, thick_cylinder_axisymmetric},
            {"hollow sphere, solid", false, hollow_sphere_solid},
            {"hollow sphere, axisymmetric", false, hollow_sphere_axisymmetric}};
}

}  // namespace couture::verification
