#include "drivers/bench.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <nlohmann/json.hpp>

#include "iga/assembly/assembler.h"
#include "iga/assembly/elasticity.h"
#include "iga/assembly/patch_stencil.h"
#include "iga/assembly/sparsity.h"
#include "iga/core/log.h"
#include "iga/core/parallel.h"
#include "iga/core/timer.h"
#include "iga/solve/linear_static.h"
#include "iga/spline/shapes.h"
#include "meshing/parts/part_surface.h"
#include "meshing/parts/part_surface_builder.h"
#include "meshing/topology/handle_tunnel_loops.h"
#include "meshing/topology/pants.h"

namespace couture::drivers {

using namespace iga;

namespace {

/// Degree 1 does not hold the arcs: B-splines on the map of degree 2.
SpacePtr<3> annulus(int degree, int n_elements) {
    MultiPatch<3> part;
    part.patches = {make_extrusion(make_quarter_annulus(1.0, 2.0), Vector3(0.0, 0.0, 1.0))};
    part.boundary_sets["end"] = {make_side<3>(0, 4)};
    if (degree == 1) {
        const KnotVector knots = KnotVector::uniform(1, n_elements);
        return std::make_shared<const Space<3>>(
            part, std::vector<TensorSpace<3>>{{{knots, knots, knots}}});
    }
    return std::make_shared<const Space<3>>(
        refine<3>(part, degree, std::array<int, 3>{n_elements, n_elements, n_elements}));
}

Problem elastic_problem() {
    Problem problem;
    Material material;
    material.name = "unit";
    material.stiffness = isotropic_stiffness(1.0, 0.3);
    problem.materials = {material};
    Support held;
    held.on = "end";
    held.components = {constant(0.0), constant(0.0), constant(0.0)};
    problem.supports = {held};
    BodyForce weight;
    weight.components = {constant(0.0), constant(0.0), constant(-1.0)};
    problem.body_forces = {weight};
    return problem;
}

AssemblyRow measure_assembly(const std::string& name, int degree, int n_elements, int threads,
                             int n_runs) {
    const SpacePtr<3> owner = annulus(degree, n_elements);
    const Space<3>& space = *owner;
    const bool is_scalar = name == "scalar";
    const BilinearForm<3> form =
        is_scalar ? scalar_form<3>(1.0, 0.0) : stiffness_form<3>(elastic_problem(), 1);
    AssemblyRow row{name, degree, n_elements, threads, space.n_dofs() * form.n_components};
    const TensorSpace<3>& tensor = space.tensor(0);
    row.flops = PatchIntegrator<3>(0, space.geometry().patches[0], tensor, space.weights(0), form,
                                   gauss_points<3>(tensor, {}))
                    .flops();
    row.seconds = 1e300;
    const int before = n_threads();
    set_n_threads(threads);
    for (int run = 0; run < n_runs; ++run) {
        const Timer timer;
        const BlockMatrix matrix = assemble(space, form);
        row.seconds = std::min(row.seconds, timer.seconds());
        row.bytes = static_cast<double>(matrix.memory());
    }
    set_n_threads(before);
    return row;
}

SolveRow measure_solve(const std::string& solver, int degree, int n_elements) {
    const SpacePtr<3> space = annulus(degree, n_elements);
    LinearStaticOptions options;
    options.solver.name = solver;
    options.solver.tolerance = 1e-8;
    const LinearStaticResult<3> result = solve_linear_static<3>(space, elastic_problem(), options);
    SolveRow row{solver, degree, n_elements, result.n_unknowns};
    for (const Phase& phase : result.phases) {
        if (phase.name == "factorization") {
            row.setup_seconds = phase.seconds;
        } else if (phase.name == "solution") {
            row.solve_seconds = phase.seconds;
        }
    }
    row.iterations = result.solver.iterations;
    row.residual = result.solver.residual;
    row.memory = static_cast<double>(result.solver.memory);
    return row;
}

/// A plate with 6 x 5 square holes, as wide as what is between them: genus 30.
meshing::TriangleSoup perforated_plate(double edge_length) {
    constexpr std::array<int, 2> n_holes = {6, 5};
    meshing::PartSurfaceBuilder builder(edge_length);
    // Corners of a rectangle below and above, counter-clockwise seen from above.
    const auto corners = [&](int x_low, int y_low, int x_high, int y_high) {
        std::array<std::vector<int>, 2> vertices;
        for (int k = 0; k < 2; ++k) {
            for (const auto& [x, y] : {std::pair{x_low, y_low}, std::pair{x_high, y_low},
                                       std::pair{x_high, y_high}, std::pair{x_low, y_high}}) {
                vertices[k].push_back(builder.add_vertex({1.0 * x, 1.0 * y, 1.0 * k}));
            }
        }
        return vertices;
    };
    // `sign`: 1 if the material lies inside.
    const auto add_walls = [&](const std::string& name, const auto& vertices, int sign) {
        for (int k = 0; k < 4; ++k) {
            const int wall =
                builder.add_face(fmt::format("{}_{}", name, k), meshing::PartFaceKind::plane);
            const int next = (k + 1) % 4;
            builder.add_polygon(
                wall, {vertices[0][k], vertices[0][next], vertices[1][next], vertices[1][k]},
                k % 2 == 0 ? 1 : 0, (k == 1 || k == 2) ? sign : -sign);
        }
    };
    std::array<std::vector<int>, 2> rims;
    for (int i = 0; i < n_holes[0]; ++i) {
        for (int j = 0; j < n_holes[1]; ++j) {
            const auto hole = corners(2 * i + 1, 2 * j + 1, 2 * i + 2, 2 * j + 2);
            add_walls(fmt::format("hole_{}_{}", i, j), hole, -1);
            for (int k = 0; k < 2; ++k) {
                for (int c = 0; c < 4; ++c) {
                    rims[k].push_back(builder.add_line(hole[k][c], hole[k][(c + 1) % 4]));
                }
            }
        }
    }
    const auto outside = corners(0, 0, 2 * n_holes[0] + 1, 2 * n_holes[1] + 1);
    add_walls("side", outside, 1);
    for (int k = 0; k < 2; ++k) {
        const int face =
            builder.add_face(k == 0 ? "z_low" : "z_high", meshing::PartFaceKind::plane);
        builder.add_polygon(face, outside[k], 2, k == 0 ? -1 : 1, rims[k]);
    }
    return builder.finish().soup;
}

/// Processor time of this process so far.
double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

CuttingRow measure_cutting(const std::string& part, const meshing::TriangleSoup& soup) {
    CuttingRow row{.part = part, .n_triangles = static_cast<int>(soup.triangles.size())};
    const int before = n_threads();
    set_n_threads(1);
    const double start = cpu_seconds();
    row.genus = meshing::find_handle_tunnel_loops(meshing::CutSurface(soup)).genus;
    const double end_of_loops = cpu_seconds();
    row.loops_cpu_seconds = end_of_loops - start;
    meshing::SurfaceMesh mesh = meshing::make_surface_mesh(soup);
    static_cast<void>(meshing::decompose_into_pants(mesh));
    row.pants_cpu_seconds = cpu_seconds() - end_of_loops;
    set_n_threads(before);
    return row;
}

std::vector<CuttingRow> measure_all_cutting(bool quick) {
    std::vector<CuttingRow> rows;
    // About 2.5, 5, 10, 20, 50 and 100 thousand triangles.
    const std::vector<double> edge_lengths =
        quick ? std::vector<double>{8.7, 6.0} : std::vector<double>{8.7, 6.0, 4.3, 3.0, 1.93, 1.37};
    for (const double edge_length : edge_lengths) {
        log::info(fmt::format("loops and pants, edges of {}", edge_length));
        rows.push_back(measure_cutting(
            "sierpinski", meshing::make_part_surface("sierpinski", {}, edge_length).soup));
    }
    // About 1.6, 4.4 and 8.4 thousand triangles.
    const std::vector<double> edge_lengths_30 =
        quick ? std::vector<double>{1.0} : std::vector<double>{0.5, 0.37};
    for (const double edge_length : edge_lengths_30) {
        log::info(fmt::format("loops and pants of genus 30, edges of {}", edge_length));
        rows.push_back(measure_cutting("perforated", perforated_plate(edge_length)));
    }
    return rows;
}

double microseconds_per_n_log_n(double seconds, int n) {
    return 1e6 * seconds / (n * std::log2(n));
}

}  // namespace

BenchResult run_benchmarks(const BenchOptions& options) {
    struct Case {
        const char* problem;
        int degree;
        int n_elements;
    };
    const std::vector<Case> quick = {
        {"scalar", 1, 8}, {"scalar", 2, 16}, {"scalar", 3, 8}, {"elasticity", 2, 8}};
    const std::vector<Case> all = {
        {"scalar", 1, 48},     {"scalar", 2, 8},     {"scalar", 2, 16},     {"scalar", 2, 32},
        {"scalar", 2, 48},     {"scalar", 3, 16},    {"scalar", 3, 32},     {"scalar", 4, 24},
        {"elasticity", 1, 24}, {"elasticity", 2, 8}, {"elasticity", 2, 16}, {"elasticity", 2, 24},
        {"elasticity", 3, 16}, {"elasticity", 4, 12}};
    const auto is_wanted = [&](const std::string& section) {
        return options.only.empty() ||
               std::ranges::find(options.only, section) != options.only.end();
    };
    BenchResult result;
    for (int threads = 1; threads <= options.max_threads; ++threads) {
        log::info(fmt::format("machine limits, {} thread{}", threads, threads > 1 ? "s" : ""));
        result.limits.push_back(measure_machine(threads));
        for (const Case& c : options.quick ? quick : all) {
            if (is_wanted("assembly")) {
                log::info(fmt::format("assembly {} p{} n{}", c.problem, c.degree, c.n_elements));
                result.assembly.push_back(
                    measure_assembly(c.problem, c.degree, c.n_elements, threads, options.n_runs));
            }
        }
    }
    if (is_wanted("products")) {
        result.products = measure_products(options.quick, options.max_threads);
    }
    if (is_wanted("solution")) {
        const std::vector<std::pair<int, int>> solves =
            options.quick ? std::vector<std::pair<int, int>>{{1, 6}, {2, 6}}
                          : std::vector<std::pair<int, int>>{{1, 16}, {2, 8}, {2, 16}, {3, 8}};
        for (const auto& [degree, n_elements] : solves) {
            for (const std::string& solver : linear_solver_names()) {
                // With a matrix the last is fast diagonalization.
                if (solver != "auto" && solver != "matrix_free") {
                    log::info(fmt::format("solution {} p{} n{}", solver, degree, n_elements));
                    result.solves.push_back(measure_solve(solver, degree, n_elements));
                }
            }
        }
    }
    if (is_wanted("fast_diagonalization")) {
        result.iterative = measure_iterative_solvers(options.quick);
    }
    if (is_wanted("ranks")) {
        result.ranks = measure_ranks(options.quick);
    }
    if (is_wanted("cutting")) {
        result.cuts = measure_all_cutting(options.quick);
    }
    if (is_wanted("meshing")) {
        result.meshing = measure_meshing(options.quick);
    }
    if (is_wanted("evaluation")) {
        log::info("evaluation of reduced models");
        result.evaluations = measure_evaluations(options.quick);
    }
    return result;
}

const std::vector<std::string>& bench_sections() {
    static const std::vector<std::string> names{
        "assembly", "products", "solution", "fast_diagonalization",
        "ranks",    "cutting",  "meshing",  "evaluation"};
    return names;
}

std::string bench_text(const BenchResult& result) {
    std::string text = "Machine\n  threads  triad GB/s  FMA GF/s  dgemm GF/s\n";
    for (const MachineLimits& limits : result.limits) {
        text += fmt::format("  {:7}  {:10.1f}  {:8.1f}  {:10.1f}\n", limits.n_threads,
                            limits.triad * 1e-9, limits.fma * 1e-9, limits.dgemm * 1e-9);
    }
    text +=
        "\nAssembly: quarter-annulus NURBS patch, p + 1 Gauss points, best of several\n"
        "  problem     p   n  threads  unknowns   seconds  us/unknown   GF/s  of FMA  "
        "matrix MB   GB/s  of triad\n";
    for (const AssemblyRow& row : result.assembly) {
        const MachineLimits& limits = result.limits[row.n_threads - 1];
        text += fmt::format(
            "  {:10}  {}  {:2}  {:7}  {:8}  {:8.4f}  {:10.2f}  {:5.1f}  {:5.1f}%  {:9.1f}  "
            "{:5.2f}  {:7.1f}%\n",
            row.problem, row.degree, row.n_elements, row.n_threads, row.n_unknowns, row.seconds,
            1e6 * row.seconds / row.n_unknowns, 1e-9 * row.flops / row.seconds,
            100.0 * row.flops / row.seconds / limits.fma, 1e-6 * row.bytes,
            1e-9 * row.bytes / row.seconds, 100.0 * row.bytes / row.seconds / limits.triad);
    }
    text +=
        "\nSolution: elasticity, one side held, to 1e-8\n"
        "  solver                p   n  unknowns   set-up s   solve s  iterations  residual  "
        "memory MB\n";
    for (const SolveRow& row : result.solves) {
        text += fmt::format("  {:20}  {}  {:2}  {:8}  {:9.3f}  {:8.3f}  {:10}  {:8.1e}  {:>9}\n",
                            row.solver, row.degree, row.n_elements, row.n_unknowns,
                            row.setup_seconds, row.solve_seconds, row.iterations, row.residual,
                            row.memory > 0.0 ? fmt::format("{:.0f}", 1e-6 * row.memory) : "-");
    }
    text += products_text(result.products, result.limits);
    text += iterative_text(result.iterative);
    text += ranks_text(result.ranks);
    text +=
        "\nLoops and pants: one thread, processor time; pants with their loops; us over n log2 n\n"
        "  part        genus  triangles   loops s   pants s  loops us/nlogn  pants us/nlogn\n";
    for (const CuttingRow& row : result.cuts) {
        text +=
            fmt::format("  {:10}  {:5}  {:9}  {:8.2f}  {:8.2f}  {:14.2f}  {:14.2f}\n", row.part,
                        row.genus, row.n_triangles, row.loops_cpu_seconds, row.pants_cpu_seconds,
                        microseconds_per_n_log_n(row.loops_cpu_seconds, row.n_triangles),
                        microseconds_per_n_log_n(row.pants_cpu_seconds, row.n_triangles));
    }
    text +=
        "\nMeshing: one thread, processor time of the whole way, without files\n"
        "  part   task                 input  patches  elements  scaled J         s\n";
    for (const MeshingRow& row : result.meshing) {
        text += fmt::format(
            "  {:5}  {:19}  {:6}  {:7}  {:8}  {:>8}  {:8.2f}\n", row.part, row.task, row.n_input,
            row.n_patches, row.n_elements,
            row.min_scaled_jacobian > 0.0 ? fmt::format("{:.3f}", row.min_scaled_jacobian) : "-",
            row.cpu_seconds);
    }
    text += evaluation_text(result.evaluations);
    text += fmt::format("\nPeak memory of the process: {:.0f} MB\n", 1e-6 * peak_memory());
    return text;
}

std::string bench_json(const BenchResult& result) {
    nlohmann::ordered_json json;
    json["machine"] = nlohmann::ordered_json::array();
    for (const MachineLimits& limits : result.limits) {
        json["machine"].push_back({{"threads", limits.n_threads},
                                   {"triad_bytes_per_second", limits.triad},
                                   {"fma_flops", limits.fma},
                                   {"dgemm_flops", limits.dgemm}});
    }
    json["assembly"] = nlohmann::ordered_json::array();
    for (const AssemblyRow& row : result.assembly) {
        json["assembly"].push_back({{"problem", row.problem},
                                    {"degree", row.degree},
                                    {"elements_per_direction", row.n_elements},
                                    {"threads", row.n_threads},
                                    {"unknowns", row.n_unknowns},
                                    {"seconds", row.seconds},
                                    {"flop", row.flops},
                                    {"bytes", row.bytes}});
    }
    json["solution"] = nlohmann::ordered_json::array();
    for (const SolveRow& row : result.solves) {
        json["solution"].push_back({{"solver", row.solver},
                                    {"degree", row.degree},
                                    {"elements_per_direction", row.n_elements},
                                    {"unknowns", row.n_unknowns},
                                    {"setup_seconds", row.setup_seconds},
                                    {"solve_seconds", row.solve_seconds},
                                    {"iterations", row.iterations},
                                    {"residual", row.residual},
                                    {"memory_bytes", row.memory}});
    }
    json["products"] = nlohmann::ordered_json::array();
    for (const ProductRow& row : result.products) {
        json["products"].push_back({{"problem", row.problem},
                                    {"degree", row.degree},
                                    {"elements_per_direction", row.n_elements},
                                    {"threads", row.n_threads},
                                    {"unknowns", row.n_unknowns},
                                    {"assembly_seconds", row.assembly_seconds},
                                    {"matrix_seconds", row.matrix_seconds},
                                    {"matrix_bytes", row.matrix_bytes},
                                    {"setup_seconds", row.setup_seconds},
                                    {"operator_seconds", row.operator_seconds},
                                    {"operator_bytes", row.operator_bytes}});
    }
    json["fast_diagonalization"] = nlohmann::ordered_json::array();
    for (const IterativeRow& row : result.iterative) {
        json["fast_diagonalization"].push_back({{"problem", row.problem},
                                                {"geometry", row.geometry},
                                                {"patches", row.n_patches},
                                                {"degree", row.degree},
                                                {"elements_per_direction", row.n_elements},
                                                {"unknowns", row.n_unknowns},
                                                {"assembly_seconds", row.assembly_seconds},
                                                {"setup_seconds", row.setup_seconds},
                                                {"solve_seconds", row.solve_seconds},
                                                {"iterations", row.iterations},
                                                {"residual", row.residual},
                                                {"jacobi_seconds", row.jacobi_seconds},
                                                {"jacobi_iterations", row.jacobi_iterations}});
    }
    json["ranks"] = nlohmann::ordered_json::array();
    for (const RankRow& row : result.ranks) {
        json["ranks"].push_back({{"task", row.task},
                                 {"solver", row.solver},
                                 {"degree", row.degree},
                                 {"elements_per_direction", row.n_elements},
                                 {"ranks", row.n_ranks},
                                 {"unknowns", row.n_unknowns},
                                 {"assembly_seconds", row.assembly_seconds},
                                 {"setup_seconds", row.setup_seconds},
                                 {"solve_seconds", row.solve_seconds},
                                 {"iterations", row.iterations},
                                 {"unknowns_of_rank", row.unknowns_of_rank},
                                 {"neighbours", row.neighbours},
                                 {"bytes_sent", row.bytes_sent},
                                 {"peak_memory_bytes", row.peak_memory}});
    }
    json["cutting"] = nlohmann::ordered_json::array();
    for (const CuttingRow& row : result.cuts) {
        json["cutting"].push_back({{"part", row.part},
                                   {"genus", row.genus},
                                   {"triangles", row.n_triangles},
                                   {"loops_cpu_seconds", row.loops_cpu_seconds},
                                   {"pants_cpu_seconds", row.pants_cpu_seconds}});
    }
    json["meshing"] = nlohmann::ordered_json::array();
    for (const MeshingRow& row : result.meshing) {
        json["meshing"].push_back({{"part", row.part},
                                   {"task", row.task},
                                   {"input", row.n_input},
                                   {"patches", row.n_patches},
                                   {"elements", row.n_elements},
                                   {"min_scaled_jacobian", row.min_scaled_jacobian},
                                   {"cpu_seconds", row.cpu_seconds}});
    }
    json["evaluation"] = nlohmann::ordered_json::array();
    for (const EvaluationRow& row : result.evaluations) {
        json["evaluation"].push_back({{"modes", row.n_modes},
                                      {"unknowns", row.n_unknowns},
                                      {"samples", row.n_samples},
                                      {"fields_cpu_seconds", row.fields_seconds},
                                      {"samples_cpu_seconds", row.samples_seconds},
                                      {"batch_cpu_seconds", row.batch_seconds},
                                      {"errors_cpu_seconds", row.errors_seconds},
                                      {"gradient_cpu_seconds", row.gradient_seconds}});
    }
    json["peak_memory_bytes"] = peak_memory();
    return json.dump(2);
}

}  // namespace couture::drivers
