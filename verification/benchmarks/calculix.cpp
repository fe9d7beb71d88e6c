#include "verification/benchmarks/calculix.h"

#include <cmath>

#include "iga/topology/multipatch_interpolate.h"
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
constexpr double cook_shear_modulus = 0.375;

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

/// A cube of 4 x 3 x 5 elements whose nodes are moved by up to a seventh of an element, bent and
/// pulled by prescribed displacements of one end and a traction on a side; or its mirror image,
/// whose patch is left-handed.
void distorted_block(Recorder& recorder, bool is_mirrored) {
    MultiPatch<3> block = refine<3>(part<3>("box"), 1, std::array<int, 3>{4, 3, 5});
    MatrixX nodes = block.patches[0].control_points();
    for (long i = 0; i < nodes.rows(); ++i) {
        const Vector3 x = nodes.row(i);
        nodes(i, 0) += 0.03 * std::sin(9.0 * x[1] + 5.0 * x[2]);
        nodes(i, 1) += 0.04 * std::sin(7.0 * x[0] - 8.0 * x[2]);
        nodes(i, 2) += 0.03 * std::cos(11.0 * x[0] + 6.0 * x[1]);
    }
    if (is_mirrored) {
        nodes.col(1) *= -1.0;
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
    Problem problem = neo_hookean_problem(Kinematics::solid, cook_shear_modulus, 1.0);
    problem.supports = {make_support("clamped", 0.0, 0.0), make_support("z_low", {}, {}, 0.0),
                        make_support("z_high", {}, {}, 0.0)};
    Traction load;
    load.on = "loaded";
    load.components = {constant(0.0), constant(1.0 / 16.0), constant(0.0)};
    problem.tractions = {load};
    compare(recorder, std::make_shared<const Space<3>>(slab), problem, 0.1);
}

/// The node at a place.
int node_at(const io::HexMesh& mesh, const Vector3& place) {
    Eigen::Index nearest = 0;
    (mesh.nodes.rowwise() - place.transpose()).rowwise().norm().minCoeff(&nearest);
    return static_cast<int>(nearest);
}

/// The slab with bricks of 20 nodes. A uniform traction on the rectangular faces of the loaded side
/// gives -1/12 of a face's force to each corner and 1/3 to each middle of an edge.
io::CalculixModel quadratic_cook(int n_elements, double kappa) {
    constexpr std::array<int, 4> corners = {1, 2, 5, 6};
    constexpr std::array<int, 4> middles = {9, 13, 17, 18};
    io::CalculixModel model;
    model.mesh = io::make_hexahedra(
        *io::make_hexahedral_space(part<3>("cook_3d"), 2, {n_elements, n_elements, 1}));
    model.material = make_hyperelastic(StoredEnergy::neo_hookean, cook_shear_modulus, kappa);
    model.is_reduced = true;
    model.is_automatic = true;
    for (const int node : model.mesh.node_sets.at("clamped")) {
        model.displacements.push_back({node, 0, 0.0});
        model.displacements.push_back({node, 1, 0.0});
    }
    for (int node = 0; node < model.mesh.nodes.rows(); ++node) {
        model.displacements.push_back({node, 2, 0.0});
    }
    const double force_on_face = 1.0 / n_elements;
    for (long e = 0; e < model.mesh.elements.rows(); ++e) {
        if (model.mesh.places[e].element[0] == n_elements - 1) {
            for (int i = 0; i < 4; ++i) {
                model.forces.push_back(
                    {model.mesh.elements(e, corners[i]), 1, -force_on_face / 12.0});
                model.forces.push_back(
                    {model.mesh.elements(e, middles[i]), 1, force_on_face / 3.0});
            }
        }
    }
    return model;
}

void quadratic_bricks(Recorder& recorder, const std::string& material, int n_elements, double kappa,
                      double middle, double corner, double bound) {
    recorder.set_source("CalculiX 2.20, C3D20R; converged value");
    const io::CalculixModel model = quadratic_cook(n_elements, kappa);
    const io::CalculixResult result = run_calculix(model);
    const auto deflection = [&](double y) {
        return result.displacements(node_at(model.mesh, {48.0, y, 0.0}), 1);
    };
    recorder.relative("v(48, 52), " + material, middle, deflection(52.0), bound);
    recorder.relative("v(48, 60), " + material, corner, deflection(60.0), bound);
}

void quadratic_cook_cases(Recorder& recorder) {
    quadratic_bricks(recorder, "nu = 1/3", 16, 1.0, 15.593, 14.4975, 2e-3);
    quadratic_bricks(recorder, "kappa / mu = 1000", 24, 375.0, 13.174, 12.516, 1e-2);
}

/// The half seal's arm pushed in by 26 mm, as drivers/decks/half_seal.toml does without meshing
/// again: nodes on the exact geometry, its cuts held, the cap guided.
void half_seal(Recorder& recorder, double bulk_modulus_of_seal, double divisions) {
    const MultiPatch<3> seal =
        interpolate<3>(part<3>("half_seal", {{"divisions", divisions}}), 1, std::nullopt);
    Problem problem = neo_hookean_problem(Kinematics::solid, shear_modulus, bulk_modulus_of_seal);
    problem.supports = {make_support("cuts", 0.0, 0.0, 0.0), make_support("cap", -26.0, 0.0, 0.0)};
    compare(recorder, std::make_shared<const Space<3>>(seal), problem, 0.05);
}

Case half_seal_case(const std::string& name, double kappa, double divisions, bool is_long) {
    return calculix_case(name, is_long,
                         [=](Recorder& recorder) { half_seal(recorder, kappa, divisions); });
}

}  // namespace

std::vector<Case> calculix_cases() {
    return {calculix_case("CalculiX, distorted block", false,
                          [](Recorder& r) { distorted_block(r, false); }),
            calculix_case("CalculiX, left-handed block", false,
                          [](Recorder& r) { distorted_block(r, true); }),
            calculix_case("CalculiX, Cook's membrane", false, cook_slab),
            calculix_case("CalculiX, Cook's membrane, quadratic", false, quadratic_cook_cases),
            half_seal_case("CalculiX, half-seal, 144 elements", bulk_modulus, 1.0, false),
            half_seal_case("CalculiX, half-seal, kappa = 20", bulk_modulus, 3.0, true),
            half_seal_case("CalculiX, half-seal, kappa = 10", 10.0, 3.0, true)};
}

}  // namespace couture::verification
