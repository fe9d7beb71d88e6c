#include "verification/manufactured/convergence.h"

#include <fmt/format.h>

#include <cmath>

#include "verification/manufactured/wave.h"
#include "verification/problem_tools.h"

namespace couture::verification {

using namespace iga;

namespace {

constexpr double order_bound = 0.1;

/// Of the waves at finite strain: gradients up to 0.3.
constexpr double finite_strain_size = 0.08;

enum class Model { poisson, elasticity, neo_hookean };

/// Two waves that no side or direction of the geometries is aligned with.
WaveSolution trigonometric(int dimension, double size) {
    WaveSolution solution{
        sine(),
        {{{1.0, -0.6, 0.8}, {1.1, 0.7, 0.5}, 0.3}, {{0.5, 0.9, -0.4}, {-0.6, 1.2, 0.8}, 1.1}}};
    for (PlaneWave& wave : solution.waves) {
        wave.amplitude *= size;
        if (dimension == 2) {
            wave.amplitude[2] = 0.0;
            wave.direction[2] = 0.0;
        }
    }
    return solution;
}

/// Solves for the waves on a space.
template <int d>
using Solver = std::function<Field<d>(const SpacePtr<d>& space)>;

template <int d>
Solver<d> make_solver(Model model, const WaveSolution& solution) {
    if (model == Model::neo_hookean) {
        SteppingOptions in_one_step;
        in_one_step.first_step = 1.0;
        in_one_step.largest_step = 1.0;
        return [=, problem = neo_hookean_wave_problem<d>(solution)](const SpacePtr<d>& space) {
            return Field<d>{space, run_to_end<d>(space, problem, in_one_step).state.displacement};
        };
    }
    const Physics physics = model == Model::poisson ? Physics::poisson : Physics::elasticity;
    return [problem = wave_problem<d>(solution, physics)](const SpacePtr<d>& space) {
        return solve<d>(space, problem).displacement;
    };
}

/// Elements per direction of the coarse and the fine mesh for one degree.
struct Meshes {
    int degree;
    int coarse;
    int fine;
};

template <int d>
void observe_orders(Recorder& recorder, Model model, const std::string& part_name,
                    const std::map<std::string, double>& sizes,
                    const std::vector<Meshes>& all_meshes) {
    recorder.set_source("manufactured: two sine waves");
    MultiPatch<d> geometry = part<d>(part_name, sizes);
    name_outer(geometry);
    const WaveSolution solution =
        trigonometric(d, model == Model::neo_hookean ? finite_strain_size : 1.0);
    const Solver<d> solver = make_solver<d>(model, solution);
    const ExactSolution<d> exact = solution.exact<d>(model == Model::poisson ? 1 : d);
    for (const Meshes& meshes : all_meshes) {
        const auto errors = [&](int n) {
            return error_norms<d>(solver(make_space<d>(geometry, meshes.degree, n)), exact);
        };
        const ErrorNorms coarse = errors(meshes.coarse);
        const ErrorNorms fine = errors(meshes.fine);
        const double log_h = std::log(static_cast<double>(meshes.fine) / meshes.coarse);
        const std::string where =
            fmt::format("p={}, n={} to {}", meshes.degree, meshes.coarse, meshes.fine);
        recorder.absolute("L2 order " + where, meshes.degree + 1.0,
                          std::log(coarse.l2 / fine.l2) / log_h, order_bound);
        recorder.absolute("H1 order " + where, meshes.degree, std::log(coarse.h1 / fine.h1) / log_h,
                          order_bound);
    }
}

template <int d>
Case convergence_case(const std::string& name, Model model, const std::string& part_name,
                      const std::vector<Meshes>& meshes,
                      const std::map<std::string, double>& sizes = {}, bool is_long = false) {
    return {name, is_long,
            [=](Recorder& r) { observe_orders<d>(r, model, part_name, sizes, meshes); }};
}

}  // namespace

std::vector<Case> convergence_cases() {
    const std::vector<Meshes> plane = {{1, 32, 64}, {2, 16, 32}, {3, 32, 64}, {4, 32, 64}};
    const std::vector<Meshes> twisted = {{1, 8, 16}, {2, 8, 12}, {3, 12, 16}, {4, 8, 10}};
    const std::vector<Meshes> plate = {{1, 8, 16}, {2, 6, 12}, {3, 6, 8}, {4, 8, 10}};
    // Its distorted patches need finer meshes than high degrees can afford.
    const std::vector<Meshes> o_grid = {{1, 6, 12}, {2, 10, 14}};
    const std::vector<Meshes> fine_plate = {{3, 8, 12}, {4, 8, 12}};
    const std::vector<Meshes> plane_finite = {{1, 32, 64}, {2, 16, 32}, {3, 32, 64}};
    const std::vector<Meshes> twisted_finite = {{1, 8, 16}, {2, 8, 12}};
    const std::vector<Meshes> fine_twisted_finite = {{3, 12, 16}};
    const std::vector<Meshes> plate_finite = {{1, 8, 16}, {2, 6, 12}, {3, 6, 8}};
    const std::map<std::string, double> square = {{"half_width", 2.0}};
    return {
        convergence_case<2>("Poisson 2D, quarter annulus", Model::poisson, "quarter_annulus",
                            plane),
        convergence_case<2>("Poisson 2D, plate with hole", Model::poisson, "plate_with_hole",
                            plane),
        convergence_case<2>("elasticity 2D, quarter annulus", Model::elasticity, "quarter_annulus",
                            plane),
        convergence_case<2>("elasticity 2D, plate with hole", Model::elasticity, "plate_with_hole",
                            plane),
        convergence_case<3>("Poisson 3D, twisted box", Model::poisson, "twisted_box", twisted),
        convergence_case<3>("Poisson 3D, plate with hole", Model::poisson, "plate_with_hole_3d",
                            plate, square),
        convergence_case<3>("Poisson 3D, O-grid cylinder", Model::poisson, "cylinder_o_grid",
                            o_grid),
        convergence_case<3>("elasticity 3D, twisted box", Model::elasticity, "twisted_box",
                            twisted),
        convergence_case<3>("elasticity 3D, plate with hole", Model::elasticity,
                            "plate_with_hole_3d", plate, square),
        convergence_case<3>("elasticity 3D, O-grid cylinder", Model::elasticity, "cylinder_o_grid",
                            o_grid),
        convergence_case<3>("elasticity 3D, plate with hole, fine", Model::elasticity,
                            "plate_with_hole_3d", fine_plate, square, true),
        convergence_case<2>("neo-Hookean 2D, quarter annulus", Model::neo_hookean,
                            "quarter_annulus", plane_finite),
        convergence_case<2>("neo-Hookean 2D, plate with hole", Model::neo_hookean,
                            "plate_with_hole", plane_finite),
        convergence_case<3>("neo-Hookean 3D, twisted box", Model::neo_hookean, "twisted_box",
                            twisted_finite),
        convergence_case<3>("neo-Hookean 3D, twisted box, degree 3", Model::neo_hookean,
                            "twisted_box", fine_twisted_finite, {}, true),
        convergence_case<3>("neo-Hookean 3D, plate with hole", Model::neo_hookean,
                            "plate_with_hole_3d", plate_finite, square),
    };
}

}  // namespace couture::verification
