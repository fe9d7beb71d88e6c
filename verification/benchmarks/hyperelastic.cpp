#include "verification/benchmarks/hyperelastic.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>

#include "iga/core/error.h"
#include "verification/problem_tools.h"

namespace couture::verification {

using namespace iga;

namespace {

constexpr double shear_modulus = 3.0;
constexpr double bulk_modulus = 20.0;
/// Ten digits of the reference values.
constexpr double homogeneous_bound = 1e-8;
constexpr double inflation_bound = 1e-6;
constexpr double stress_bound = 1e-3;
constexpr double derivative_bound = 1e-8;

constexpr const char* closed_form = "closed form, W = mu/2 (J^(-2/3) I1 - 3) + kappa/2 (J - 1)^2";
constexpr const char* radial_equation = "radial equation, Runge-Kutta of order 4";

Problem neo_hookean(Kinematics kinematics, double mu = shear_modulus, double kappa = bulk_modulus) {
    return neo_hookean_problem(kinematics, mu, kappa);
}

/// Cauchy stress at a parameter of patch 0.
template <int d>
Matrix<3> cauchy_at(const Problem& problem, const Field<d>& u, const Vector<d>& xi) {
    Matrix<3> H = Matrix<3>::Zero();
    H.template topLeftCorner<d, d>() = u.gradient(0, xi);
    if (problem.kinematics == Kinematics::axisymmetric) {
        H(2, 2) = u.value(0, xi)[0] / u.space->geometry().patches[0].point(xi)[0];
    }
    return cauchy_stress(piola_stress(*problem.materials[0].hyperelastic, H), H);
}

/// A block of 2 x 2 x 2 cubic elements: named sides are moved by these stretches along x, y, z.
struct Stretches {
    std::optional<double> x, y, z;
};

Field<3> stretch_block(const Stretches& stretches) {
    const MultiPatch<3> block = part<3>("box");
    const SpacePtr<3> space = make_space<3>(block, 3, 2);
    Problem problem = neo_hookean(Kinematics::solid);
    problem.supports = {make_symmetry("x_low"), make_symmetry("y_low"), make_symmetry("z_low")};
    const auto move = [](const std::optional<double>& stretch) {
        return stretch ? std::optional<double>(*stretch - 1.0) : std::nullopt;
    };
    problem.supports.push_back(make_support("x_high", move(stretches.x), {}, {}));
    problem.supports.push_back(make_support("y_high", {}, move(stretches.y), {}));
    problem.supports.push_back(make_support("z_high", {}, {}, move(stretches.z)));
    return {space, run_to_end<3>(space, problem).state.displacement};
}

void homogeneous_states(Recorder& recorder) {
    recorder.set_source(closed_form);
    const Problem problem = neo_hookean(Kinematics::solid);
    const Vector3 middle(0.4, 0.6, 0.3);
    struct Uniaxial {
        double stretch, lateral, cauchy;
    };
    for (const Uniaxial& row :
         {Uniaxial{0.5, 1.3476184651, -5.5177341722}, Uniaxial{1.25, 0.9098158487, 2.0823658870},
          Uniaxial{1.5, 0.8441183553, 4.1282217920}, Uniaxial{2.0, 0.7544020407, 8.2946926763}}) {
        const Field<3> u = stretch_block({.x = row.stretch, .y = {}, .z = {}});
        const std::string name = fmt::format("uniaxial {:g}: ", row.stretch);
        recorder.relative(name + "lateral stretch", row.lateral, 1.0 + u.gradient(0, middle)(1, 1),
                          homogeneous_bound);
        recorder.relative(name + "Cauchy stress", row.cauchy, cauchy_at(problem, u, middle)(0, 0),
                          homogeneous_bound);
    }
    const Field<3> biaxial = stretch_block({.x = 1.5, .y = 1.5, .z = {}});
    recorder.relative("equibiaxial 1.5: thickness stretch", 0.5137691686,
                      1.0 + biaxial.gradient(0, middle)(2, 2), homogeneous_bound);
    recorder.relative("equibiaxial 1.5: Cauchy stress", 4.6794188790,
                      cauchy_at(problem, biaxial, middle)(0, 0), homogeneous_bound);
    const Field<3> plane = stretch_block({.x = 1.5, .y = {}, .z = 1.0});
    recorder.relative("plane strain 1.5: thickness stretch", 0.7293912692,
                      1.0 + plane.gradient(0, middle)(1, 1), homogeneous_bound);
    recorder.relative("plane strain 1.5: s11", 4.4366493929,
                      cauchy_at(problem, plane, middle)(0, 0), homogeneous_bound);
    recorder.relative("plane strain 1.5: s33", 1.2085648392,
                      cauchy_at(problem, plane, middle)(2, 2), homogeneous_bound);
    const Field<3> confined = stretch_block({.x = 0.8, .y = 1.0, .z = 1.0});
    recorder.relative("confined 0.8: s11", -5.0443574876,
                      cauchy_at(problem, confined, middle)(0, 0), homogeneous_bound);
    recorder.relative("confined 0.8: s22", -3.4778212562,
                      cauchy_at(problem, confined, middle)(1, 1), homogeneous_bound);
}

void simple_shear(Recorder& recorder) {
    recorder.set_source(closed_form);
    constexpr double g = 0.8;
    MultiPatch<3> block = part<3>("box");
    name_outer(block);
    const SpacePtr<3> space = make_space<3>(block, 2, 2);
    Problem problem = neo_hookean(Kinematics::solid);
    Support all = make_support("outer", 0.0, 0.0, 0.0);
    all.components[0] = [](const Vector3& x, double) { return g * x[1]; };
    problem.supports = {all};
    const Field<3> u{space, run_to_end<3>(space, problem).state.displacement};
    const Matrix<3> sigma = cauchy_at(problem, u, Vector3(0.3, 0.6, 0.5));
    recorder.relative("s12", shear_modulus * g, sigma(0, 1), homogeneous_bound);
    recorder.relative("s11", 2.0 / 3.0 * shear_modulus * g * g, sigma(0, 0), homogeneous_bound);
    recorder.relative("s22", -1.0 / 3.0 * shear_modulus * g * g, sigma(1, 1), homogeneous_bound);
}

/// Radii 1 and 2 under follower pressure.
void inflated_tube(Recorder& recorder) {
    recorder.set_source(radial_equation);
    Problem problem = neo_hookean(Kinematics::plane_strain);
    problem.supports = {make_symmetry("cut_x"), make_symmetry("cut_y")};
    problem.pressures = {make_pressure("inner", 0.7906356787)};
    const SpacePtr<2> space = make_space<2>(part<2>("thick_cylinder"), 4, {8, 4});
    const Field<2> u{space, run_to_end<2>(space, problem).state.displacement};
    recorder.relative("inner radius", 1.25, 1.0 + displacement_at<2>(u, Vector3(1.0, 0.0, 0.0))[0],
                      inflation_bound);
    recorder.relative("outer radius", 2.1486155550,
                      2.0 + displacement_at<2>(u, Vector3(2.0, 0.0, 0.0))[0], inflation_bound);
    recorder.relative("inner hoop stress", 1.81190212,
                      cauchy_at(problem, u, Vector2(0.0, 0.0))(1, 1), stress_bound);
}

void inflated_sphere(Recorder& recorder) {
    recorder.set_source(radial_equation);
    MultiPatch<2> meridian = part<2>("half_annulus");
    const Interface<2>& equator = meridian.interfaces.at(0);
    meridian.boundary_sets["equator"] = {make_side<2>(equator.first_patch, equator.first_side)};
    Problem problem = neo_hookean(Kinematics::axisymmetric);
    problem.supports = {make_support("axis", 0.0, {}), make_support("equator", {}, 0.0)};
    problem.pressures = {make_pressure("inner", 1.5852831980)};
    const SpacePtr<2> space = make_space<2>(meridian, 4, {8, 4});
    const Field<2> u{space, run_to_end<2>(space, problem).state.displacement};
    recorder.relative("inner radius", 1.25, 1.0 + displacement_at<2>(u, Vector3(1.0, 0.0, 0.0))[0],
                      inflation_bound);
    recorder.relative("outer radius", 2.0881144020,
                      2.0 + displacement_at<2>(u, Vector3(2.0, 0.0, 0.0))[0], inflation_bound);
}

/// Radii 1 and 4, mu = 1/6, kappa = 2, dead radial traction 1 per undeformed area inside: the inner
/// radius grows fivefold.
void dead_load_tube(Recorder& recorder) {
    recorder.set_source(radial_equation);
    Problem problem = neo_hookean(Kinematics::plane_strain, 1.0 / 6.0, 2.0);
    problem.supports = {make_symmetry("cut_x"), make_symmetry("cut_y")};
    problem.pressures = {make_pressure("inner", 1.0)};
    problem.pressures[0].follows_body = false;
    const MultiPatch<2> ring =
        part<2>("thick_cylinder", {{"inner_radius", 1.0}, {"outer_radius", 4.0}});
    const SpacePtr<2> space = make_space<2>(ring, 4, {16, 4});
    SteppingOptions options;
    options.first_step = 0.05;
    options.largest_step = 0.1;
    const Field<2> u{space, run_to_end<2>(space, problem, options).state.displacement};
    recorder.relative("inner radius", 4.9745887,
                      1.0 + displacement_at<2>(u, Vector3(1.0, 0.0, 0.0))[0], 1e-5);
    recorder.relative("outer radius", 6.4274441,
                      4.0 + displacement_at<2>(u, Vector3(4.0, 0.0, 0.0))[0], 1e-5);
}

/// Deformation gradients with stretches from 0.15 to 3, volumes down to a hundredth, and their
/// smallest stretch.
struct Deformation {
    Matrix<3> H;
    double smallest_stretch;
};

std::vector<Deformation> random_deformations() {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> component(-1.0, 1.0);
    std::uniform_real_distribution<double> log_stretch(std::log(0.15), std::log(3.0));
    const auto rotation = [&] {
        return Eigen::Quaterniond(component(random), component(random), component(random),
                                  component(random))
            .normalized()
            .toRotationMatrix();
    };
    std::vector<Deformation> result;
    for (int i = 0; i < 200; ++i) {
        Vector3 stretches;
        for (double& stretch : stretches) {
            stretch = std::exp(log_stretch(random));
        }
        const Matrix<3> R = rotation();
        const Matrix<3> F = R * stretches.asDiagonal() * rotation();
        result.push_back({F - Matrix<3>::Identity(), stretches.minCoeff()});
    }
    return result;
}

/// Derivative of f by each entry (i, J) of H, by central differences of order 4: column 3 i + J.
/// The step is small against the smallest stretch.
template <typename Values>
MatrixX differences(const Deformation& at, const Values& f) {
    const double step = 1e-3 * at.smallest_stretch;
    MatrixX result(f(at.H).size(), 9);
    for (int i = 0; i < 3; ++i) {
        for (int J = 0; J < 3; ++J) {
            const auto moved = [&](double steps) -> VectorX {
                Matrix<3> H = at.H;
                H(i, J) += steps * step;
                return f(H);
            };
            result.col(3 * i + J) =
                (8.0 * (moved(1.0) - moved(-1.0)) - (moved(2.0) - moved(-2.0))) / (12.0 * step);
        }
    }
    return result;
}

void derivatives(Recorder& recorder) {
    recorder.set_source("central differences of order 4, 200 random F");
    const std::vector<Deformation> deformations = random_deformations();
    const std::vector<std::pair<std::string, StoredEnergy>> energies = {
        {"neo_hookean", StoredEnergy::neo_hookean},
        {"neo_hookean_logarithmic", StoredEnergy::neo_hookean_logarithmic},
        {"saint_venant_kirchhoff", StoredEnergy::saint_venant_kirchhoff}};
    for (const auto& [name, energy] : energies) {
        const Hyperelastic material = make_hyperelastic(energy, shear_modulus, bulk_modulus);
        double of_stress = 0.0;
        double of_tangent = 0.0;
        for (const Deformation& at : deformations) {
            const auto stress = [&](const Matrix<3>& H) -> VectorX {
                return piola_stress(material, H).reshaped<Eigen::RowMajor>();
            };
            const auto stored = [&](const Matrix<3>& H) -> VectorX {
                return VectorX::Constant(1, stored_energy(material, H));
            };
            const VectorX P = stress(at.H);
            const Matrix<9> A = piola_tangent(material, at.H);
            of_stress =
                std::max(of_stress, (differences(at, stored).transpose() - P).norm() / P.norm());
            of_tangent = std::max(of_tangent, (differences(at, stress) - A).norm() / A.norm());
        }
        recorder.vanishing("stress and energy, " + name, of_stress, derivative_bound);
        recorder.vanishing("tangent and stress, " + name, of_tangent, derivative_bound);
    }
}

}  // namespace

std::vector<Case> hyperelastic_cases() {
    return {{"hyperelastic, derivatives", false, derivatives},
            {"neo-Hookean, homogeneous", false, homogeneous_states},
            {"neo-Hookean, simple shear", false, simple_shear},
            {"neo-Hookean, inflated tube", false, inflated_tube},
            {"neo-Hookean, inflated sphere", false, inflated_sphere},
            {"neo-Hookean, tube under dead load", false, dead_load_tube}};
}

}  // namespace couture::verification
