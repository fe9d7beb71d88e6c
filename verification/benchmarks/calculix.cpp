#include "verification/benchmarks/calculix.h"

#include <cmath>

#include "verification/calculix_tools.h"
#include "verification/problem_tools.h"

namespace couture::verification {

using namespace iga;

namespace {

constexpr double difference_bound = 1e-4;
/// Of the seven printed digits.
constexpr double position_bound = 1e-6;
constexpr double shear_modulus = 3.0;
constexpr double bulk_modulus = 20.0;

/// Largest difference, and that in the mean square, over the same of the expected values.
void record_differences(Recorder& recorder, const std::string& what, const MatrixX& expected,
                        const MatrixX& obtained, double bound) {
    const MatrixX difference = obtained - expected;
    recorder.vanishing("max difference of " + what,
                       difference.cwiseAbs().maxCoeff() / expected.cwiseAbs().maxCoeff(), bound);
    recorder.vanishing("L2 difference of " + what, difference.norm() / expected.norm(), bound);
}

/// The same bricks in both programs.
void compare(Recorder& recorder, const SpacePtr<3>& space, const Problem& problem,
             double increment) {
    recorder.set_source("CalculiX 2.20, C3D8 on the same mesh");
    io::CalculixModel model = io::make_calculix_model(space, problem);
    model.increment = increment;
    const io::CalculixResult other = run_calculix(model);
    SteppingOptions options;
    options.first_step = increment;
    options.largest_step = increment;
    const Field<3> u{space, run_to_end<3>(space, problem, options).state.displacement};
    const BrickStresses ours = brick_stresses(model.mesh, u, model.material);
    recorder.vanishing(
        "max distance of Gauss points, over size",
        (ours.points - other.points).cwiseAbs().maxCoeff() / space->geometry().size(),
        position_bound);
    record_differences(recorder, "displacements", other.displacements, u.coefficients,
                       difference_bound);
    record_differences(recorder, "stresses", other.stresses, ours.stresses, difference_bound);
}

/// A cube of 4 x 3 x 5 elements whose nodes are moved by up to a seventh of an element; bent and
/// pulled by prescribed displacements of one end and a traction on the top.
void distorted_block(Recorder& recorder) {
    MultiPatch<3> block = refine<3>(part<3>("box"), 1, std::array<int, 3>{4, 3, 5});
    MatrixX nodes = block.patches[0].control_points();
    for (long i = 0; i < nodes.rows(); ++i) {
        const Vector3 x = nodes.row(i);
        nodes(i, 0) += 0.03 * std::sin(9.0 * x[1] + 5.0 * x[2]);
        nodes(i, 1) += 0.04 * std::sin(7.0 * x[0] - 8.0 * x[2]);
        nodes(i, 2) += 0.03 * std::cos(11.0 * x[0] + 6.0 * x[1]);
    }
    block.patches[0] = Patch<3>(block.patches[0].space(), nodes);
    Problem problem = neo_hookean_problem(Kinematics::solid, shear_modulus, bulk_modulus);
    problem.supports = {make_support("z_low", 0.0, 0.0, 0.0),
                        make_support("z_high", 0.3, -0.1, 0.25)};
    Traction load;
    load.on = "x_high";
    load.components = {constant(0.4), constant(0.1), constant(-0.3)};
    problem.tractions = {load};
    compare(recorder, std::make_shared<const Space<3>>(block), problem, 0.25);
}

/// Cook's membrane as a slab one element thick whose faces keep their z.
void cook_slab(Recorder& recorder) {
    const MultiPatch<3> slab = refine<3>(part<3>("cook_3d"), 1, std::array<int, 3>{24, 24, 1});
    Problem problem = neo_hookean_problem(Kinematics::solid, 0.375, 1.0);
    problem.supports = {make_support("clamped", 0.0, 0.0), make_support("z_low", {}, {}, 0.0),
                        make_support("z_high", {}, {}, 0.0)};
    Traction load;
    load.on = "loaded";
    load.components = {constant(0.0), constant(1.0 / 16.0), constant(0.0)};
    problem.tractions = {load};
    compare(recorder, std::make_shared<const Space<3>>(slab), problem, 0.1);
}

}  // namespace

std::vector<Case> calculix_cases() {
    return {calculix_case("CalculiX, distorted block", false, distorted_block),
            calculix_case("CalculiX, Cook's membrane", false, cook_slab)};
}

}  // namespace couture::verification
