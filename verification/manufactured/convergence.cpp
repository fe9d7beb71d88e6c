#include "verification/manufactured/convergence.h"

#include <fmt/format.h>

#include <cmath>

#include "verification/manufactured/wave.h"
#include "verification/problem_tools.h"

namespace couture::verification {

using namespace iga;

namespace {

constexpr double order_bound = 0.1;

/// Two waves that no side or direction of the geometries is aligned with.
WaveSolution trigonometric(int dimension) {
    WaveSolution solution{
        sine(),
        {{{1.0, -0.6, 0.8}, {1.1, 0.7, 0.5}, 0.3}, {{0.5, 0.9, -0.4}, {-0.6, 1.2, 0.8}, 1.1}}};
    if (dimension == 2) {
        for (PlaneWave& wave : solution.waves) {
            wave.amplitude[2] = 0.0;
            wave.direction[2] = 0.0;
        }
    }
    return solution;
}

/// Elements per direction of the coarse and the fine mesh for one degree.
struct Meshes {
    int degree;
    int coarse;
    int fine;
};

template <int d>
void observe_orders(Recorder& recorder, Physics physics, const std::string& part_name,
                    const std::map<std::string, double>& sizes,
                    const std::vector<Meshes>& all_meshes) {
    recorder.set_source("manufactured: two sine waves");
    MultiPatch<d> geometry = part<d>(part_name, sizes);
    name_outer(geometry);
    const WaveSolution solution = trigonometric(d);
    const Problem problem = wave_problem<d>(solution, physics);
    const ExactSolution<d> exact = solution.exact<d>(physics == Physics::poisson ? 1 : d);
    for (const Meshes& meshes : all_meshes) {
        const auto errors = [&](int n) {
            return error_norms<d>(
                solve<d>(make_space<d>(geometry, meshes.degree, n), problem).displacement, exact);
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
Case convergence_case(const std::string& name, Physics physics, const std::string& part_name,
                      const std::vector<Meshes>& meshes,
                      const std::map<std::string, double>& sizes = {}, bool is_long = false) {
    return {name, is_long,
            [=](Recorder& r) { observe_orders<d>(r, physics, part_name, sizes, meshes); }};
}

}  // namespace

std::vector<Case> convergence_cases() {
    const std::vector<Meshes> plane = {{1, 32, 64}, {2, 16, 32}, {3, 32, 64}, {4, 32, 64}};
    const std::vector<Meshes> twisted = {{1, 8, 16}, {2, 8, 12}, {3, 12, 16}, {4, 8, 10}};
    const std::vector<Meshes> plate = {{1, 8, 16}, {2, 6, 12}, {3, 6, 8}, {4, 8, 10}};
    // Its distorted patches need finer meshes than high degrees can afford.
    const std::vector<Meshes> o_grid = {{1, 6, 12}, {2, 10, 14}};
    const std::vector<Meshes> fine_plate = {{3, 8, 12}, {4, 8, 12}};
    const std::map<std::string, double> square = {{"half_width", 2.0}};
    return {
        convergence_case<2>("Poisson 2D, quarter annulus", Physics::poisson, "quarter_annulus",
                            plane),
        convergence_case<2>("Poisson 2D, plate with hole", Physics::poisson, "plate_with_hole",
                            plane),
        convergence_case<2>("elasticity 2D, quarter annulus", Physics::elasticity,
                            "quarter_annulus", plane),
        convergence_case<2>("elasticity 2D, plate with hole", Physics::elasticity,
                            "plate_with_hole", plane),
        convergence_case<3>("Poisson 3D, twisted box", Physics::poisson, "twisted_box", twisted),
        convergence_case<3>("Poisson 3D, plate with hole", Physics::poisson, "plate_with_hole_3d",
                            plate, square),
        convergence_case<3>("Poisson 3D, O-grid cylinder", Physics::poisson, "cylinder_o_grid",
                            o_grid),
        convergence_case<3>("elasticity 3D, twisted box", Physics::elasticity, "twisted_box",
                            twisted),
        convergence_case<3>("elasticity 3D, plate with hole", Physics::elasticity,
                            "plate_with_hole_3d", plate, square),
        convergence_case<3>("elasticity 3D, O-grid cylinder", Physics::elasticity,
                            "cylinder_o_grid", o_grid),
        convergence_case<3>("elasticity 3D, plate with hole, fine", Physics::elasticity,
                            "plate_with_hole_3d", fine_plate, square, true),
    };
}

}  // namespace couture::verification
