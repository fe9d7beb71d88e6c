#include "drivers/solver_bench.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "iga/assembly/assembler.h"
#include "iga/assembly/constraints.h"
#include "iga/assembly/elasticity.h"
#include "iga/assembly/form_operator.h"
#include "iga/assembly/loads.h"
#include "iga/core/error.h"
#include "iga/core/log.h"
#include "iga/core/parallel.h"
#include "iga/core/timer.h"
#include "iga/linalg/conjugate_gradients.h"
#include "iga/linalg/system_checks.h"
#include "iga/solve/static_system.h"
#include "iga/spline/shapes.h"
#include "iga/topology/interface_match.h"

namespace couture::drivers {

using namespace iga;

namespace {

constexpr double tolerance = 1e-8;
/// Products with the matrix that the comparison may take.
constexpr int max_jacobi_iterations = 5000;
/// Patches along each direction of 27.
constexpr int n_layers = 3;

/// A bar of degrees (2, 2, 3) whose sections turn by 0.6 and whose axis bows.
Volume make_twisted_box() {
    const TensorSpace<3> space{
        {KnotVector::uniform(2, 1), KnotVector::uniform(2, 1), KnotVector::uniform(3, 1)}};
    MatrixX points(space.n_basis(), 3);
    for (int f = 0; f < space.n_basis(); ++f) {
        const auto i = space.indices(f);
        const double x = 0.5 * i[0] - 0.5;
        const double y = 0.5 * i[1] - 0.5;
        const double zeta = i[2] / 3.0;
        const double angle = 0.6 * zeta;
        points.row(f) << std::cos(angle) * x - std::sin(angle) * y + 0.8 * zeta * (1.0 - zeta),
            std::sin(angle) * x + std::cos(angle) * y, 2.0 * zeta;
    }
    return {space, points};
}

Curve make_segment(const Vector2& from, const Vector2& to) {
    MatrixX points(3, 2);
    points << from.transpose(), 0.5 * (from + to).transpose(), to.transpose();
    return {TensorSpace<1>{{KnotVector::uniform(2, 1)}}, points};
}

/// A square core with half a diagonal of 0.4, a ring to radius 0.7 and one to 1.
std::vector<Surface> make_disc() {
    const auto corner = [](int i) {
        const double angle = (0.25 + 0.5 * i) * std::numbers::pi;
        return Vector2(0.4 * std::cos(angle), 0.4 * std::sin(angle));
    };
    std::vector<Surface> disc{
        make_coons(make_segment(corner(2), corner(3)), make_segment(corner(1), corner(0)),
                   make_segment(corner(2), corner(1)), make_segment(corner(3), corner(0)))};
    for (int i = 0; i < 4; ++i) {
        const double start = (0.25 + 0.5 * i) * std::numbers::pi;
        const Curve middle = make_arc(0.7, start, 0.5 * std::numbers::pi);
        const Curve outer = make_arc(1.0, start, 0.5 * std::numbers::pi);
        disc.push_back(make_ruled(middle, make_segment(corner(i), corner(i + 1))));
        disc.push_back(make_ruled(outer, middle));
    }
    return disc;
}

Volume moved(const Volume& volume, const Vector3& by) {
    MatrixX points = volume.control_points();
    points.rowwise() += by.transpose();
    return {volume.space(), points, volume.weights()};
}

MultiPatch<3> make_geometry(const std::string& name) {
    MultiPatch<3> part;
    if (name == "annulus") {
        part.patches = {make_extrusion(make_quarter_annulus(1.0, 2.0), Vector3(0.0, 0.0, 1.0))};
    } else if (name == "twisted_box") {
        part.patches = {make_twisted_box()};
    } else if (name == "boxes") {
        for (int i = 0; i < n_layers * n_layers * n_layers; ++i) {
            part.patches.push_back(
                moved(make_box<3>(Vector3::Ones()),
                      Vector3(i % n_layers, i / n_layers % n_layers, i / (n_layers * n_layers))));
        }
    } else {
        for (int layer = 0; layer < n_layers; ++layer) {
            for (const Surface& surface : make_disc()) {
                part.patches.push_back(moved(make_extrusion(surface, Vector3(0.0, 0.0, 0.5)),
                                             Vector3(0.0, 0.0, 0.5 * layer)));
            }
        }
    }
    find_interfaces(part);
    for (const PatchEntity<3>& side : part.outer_sides()) {
        // All patches have direction 2 along z.
        const bool is_lowest = part.patches[side.patch].control_points().col(2).minCoeff() == 0.0;
        if (side.side() == 4 && is_lowest) {
            part.boundary_sets["end"].push_back(side);
        }
    }
    return part;
}

Problem make_problem(const std::string& name) {
    Problem problem;
    problem.physics = name == "poisson" ? Physics::poisson : Physics::elasticity;
    Material material;
    material.name = "unit";
    material.conductivity = 1.0;
    material.stiffness = isotropic_stiffness(1.0, 0.3);
    problem.materials = {material};
    Support held;
    held.on = "end";
    BodyForce weight;
    const int nc = name == "poisson" ? 1 : 3;
    for (int c = 0; c < nc; ++c) {
        held.components[c] = constant(0.0);
        weight.components[c] = constant(1.0);
    }
    problem.supports = {held};
    problem.body_forces = {weight};
    return problem;
}

}  // namespace

IterativeRow measure_iterative_solver(const std::string& problem_name, const std::string& geometry,
                                      int degree, int n_elements) {
    const MultiPatch<3> part = make_geometry(geometry);
    const KnotVector knots = KnotVector::uniform(degree, n_elements);
    const Space<3> space(part,
                         std::vector<TensorSpace<3>>(part.patches.size(), {{knots, knots, knots}}));
    const Problem problem = make_problem(problem_name);
    const int nc = n_components<3>(problem);
    IterativeRow row{problem_name, geometry,   space.n_patches(),
                     degree,       n_elements, nc * space.n_dofs()};

    const Timer assembly;
    const BlockMatrix K = assemble(space, stiffness_form<3>(problem, space.n_patches()));
    row.assembly_seconds = assembly.seconds();
    const Constraints<3> constraints = make_constraints(space, problem, {""});
    std::vector<std::string> names;
    const LinearSystem system{K, constraints.is_fixed, rigid_body_modes(space, problem, names),
                              &space};
    const VectorX b =
        free_part(constraints.is_fixed, flatten(assemble_loads(space, problem, "", {})));

    SolverOptions options;
    options.name = "fast_diagonalization";
    options.tolerance = tolerance;
    const auto solver = make_linear_solver(options);
    const Timer setup;
    solver->factorize(system);
    row.setup_seconds = setup.seconds();
    const Timer solve;
    MatrixX x;
    const SolveReport report = solver->solve(b, x);
    row.solve_seconds = solve.seconds();
    row.iterations = report.iterations;
    row.residual = report.residual;

    VectorX diagonal(K.n_unknowns());
    for (int i = 0; i < K.n_unknowns(); ++i) {
        diagonal[i] = K.find(i / nc, i / nc)[(i % nc) * (nc + 1)];
    }
    SolveReport jacobi;
    const Timer jacobi_timer;
    try {
        static_cast<void>(conjugate_gradients(
            "jacobi", [&](const VectorX& p) { return VectorX(K * p); }, constraints.is_fixed, b,
            [&](const VectorX& r) { return VectorX(r.cwiseQuotient(diagonal)); },
            {tolerance, max_jacobi_iterations, max_jacobi_iterations}, jacobi));
        row.jacobi_iterations = jacobi.iterations;
    } catch (const SolverError&) {
        row.jacobi_iterations = 0;
    }
    row.jacobi_seconds = jacobi_timer.seconds();
    return row;
}

std::vector<ProductRow> measure_products(bool quick, int max_threads) {
    struct Case {
        int degree;
        std::vector<int> n_elements;
    };
    const std::vector<Case> all = {
        {1, {14, 31, 67}}, {2, {13, 30, 48, 67}}, {3, {12, 29, 44, 66}}, {4, {11, 28, 40}}};
    const std::vector<Case> few = {{2, {8}}, {3, {6}}};
    const Problem problem = make_problem("elasticity");
    const int before = n_threads();
    std::vector<ProductRow> rows;
    for (const auto& [degree, sizes] : quick ? few : all) {
        for (const int n : sizes) {
            const KnotVector knots = KnotVector::uniform(degree, n);
            const Space<3> space(make_geometry("annulus"), {{{knots, knots, knots}}});
            const BilinearForm<3> form = stiffness_form<3>(problem, 1);
            for (int threads = 1; threads <= max_threads; ++threads) {
                log::info(fmt::format("products p{} n{}, {} threads", degree, n, threads));
                set_n_threads(threads);
                ProductRow row{"elasticity", degree, n, threads, 3 * space.n_dofs()};
                const VectorX u = VectorX::LinSpaced(row.n_unknowns, -1.0, 1.0);
                const auto best = [&](const auto& product) {
                    double seconds = 1e300;
                    double norm = 0.0;
                    for (int run = 0; run < 5; ++run) {
                        const Timer timer;
                        norm += VectorX(product()).norm();
                        seconds = std::min(seconds, timer.seconds());
                    }
                    return norm > 0.0 ? seconds : 0.0;
                };
                {
                    const Timer assembly;
                    const BlockMatrix K = assemble(space, form);
                    row.assembly_seconds = assembly.seconds();
                    row.matrix_bytes = static_cast<double>(K.memory());
                    row.matrix_seconds = best([&] { return K * u; });
                }
                const Timer setup;
                const FormOperator<3> by_form(space, form);
                row.setup_seconds = setup.seconds();
                row.operator_seconds = best([&] { return by_form * u; });
                row.operator_bytes = static_cast<double>(by_form.memory());
                rows.push_back(row);
            }
        }
    }
    set_n_threads(before);
    return rows;
}

std::string products_text(const std::vector<ProductRow>& rows,
                          const std::vector<MachineLimits>& limits) {
    if (rows.empty()) {
        return "";
    }
    std::string text =
        "\nProducts: elasticity on the annulus, with the assembled matrix (upper triangle of "
        "blocks) and without\n"
        "  p   n  threads  unknowns  assembly s  matrix s  ns/unknown  of triad  matrix MB  "
        "set-up s  free s  ns/unknown  free MB\n";
    for (const ProductRow& row : rows) {
        text += fmt::format(
            "  {}  {:2}  {:7}  {:8}  {:10.3f}  {:8.4f}  {:10.0f}  {:7.0f}%  {:9.0f}  {:8.3f}  "
            "{:6.4f}  {:10.0f}  {:7.0f}\n",
            row.degree, row.n_elements, row.n_threads, row.n_unknowns, row.assembly_seconds,
            row.matrix_seconds, 1e9 * row.matrix_seconds / row.n_unknowns,
            100.0 * row.matrix_bytes / row.matrix_seconds / limits[row.n_threads - 1].triad,
            1e-6 * row.matrix_bytes, row.setup_seconds, row.operator_seconds,
            1e9 * row.operator_seconds / row.n_unknowns, 1e-6 * row.operator_bytes);
    }
    return text;
}

std::vector<IterativeRow> measure_iterative_solvers(bool quick) {
    struct Case {
        const char* problem;
        const char* geometry;
        int degree;
        std::vector<int> n_elements;
    };
    // As many elements as a machine of 24 GB holds comfortably.
    const std::vector<Case> all = {{"poisson", "annulus", 1, {8, 16, 32, 64}},
                                   {"poisson", "annulus", 2, {8, 16, 32, 64}},
                                   {"poisson", "annulus", 3, {8, 16, 32, 64}},
                                   {"poisson", "annulus", 4, {8, 16, 32, 48}},
                                   {"poisson", "twisted_box", 1, {8, 16, 32, 64}},
                                   {"poisson", "twisted_box", 2, {8, 16, 32, 64}},
                                   {"poisson", "twisted_box", 3, {8, 16, 32, 64}},
                                   {"poisson", "twisted_box", 4, {8, 16, 32, 48}},
                                   {"elasticity", "annulus", 1, {8, 16, 32, 64}},
                                   {"elasticity", "annulus", 2, {8, 16, 32, 48}},
                                   {"elasticity", "annulus", 3, {8, 16, 32}},
                                   {"elasticity", "annulus", 4, {8, 16, 24}},
                                   {"elasticity", "twisted_box", 1, {8, 16, 32, 64}},
                                   {"elasticity", "twisted_box", 2, {8, 16, 32, 48}},
                                   {"elasticity", "twisted_box", 3, {8, 16, 32}},
                                   {"elasticity", "twisted_box", 4, {8, 16, 24}},
                                   {"poisson", "boxes", 1, {4, 8, 16, 24}},
                                   {"poisson", "boxes", 2, {4, 8, 16, 24}},
                                   {"poisson", "boxes", 3, {4, 8, 16}},
                                   {"poisson", "boxes", 4, {4, 8, 12}},
                                   {"poisson", "cylinder", 1, {4, 8, 16, 24}},
                                   {"poisson", "cylinder", 2, {4, 8, 16, 24}},
                                   {"poisson", "cylinder", 3, {4, 8, 16}},
                                   {"poisson", "cylinder", 4, {4, 8, 12}},
                                   {"elasticity", "boxes", 1, {4, 8, 16}},
                                   {"elasticity", "boxes", 2, {4, 8, 16}},
                                   {"elasticity", "boxes", 3, {4, 8, 12}},
                                   {"elasticity", "boxes", 4, {4, 8}},
                                   {"elasticity", "cylinder", 1, {4, 8, 16}},
                                   {"elasticity", "cylinder", 2, {4, 8, 16}},
                                   {"elasticity", "cylinder", 3, {4, 8, 12}},
                                   {"elasticity", "cylinder", 4, {4, 8}}};
    std::vector<IterativeRow> rows;
    for (const Case& c : all) {
        for (const int n : c.n_elements) {
            const bool is_small = c.degree <= 2 && n <= 8;
            if (quick && !is_small) {
                continue;
            }
            log::info(fmt::format("fast diagonalization {} {} p{} n{}", c.problem, c.geometry,
                                  c.degree, n));
            rows.push_back(measure_iterative_solver(c.problem, c.geometry, c.degree, n));
        }
    }
    return rows;
}

std::string iterative_text(const std::vector<IterativeRow>& rows) {
    std::string text =
        "\nIterations to 1e-8: fast diagonalization, beside conjugate gradients with the diagonal "
        "(n: elements per patch and direction)\n"
        "  problem     geometry     patches  p   n  unknowns  assembly s  set-up s   solve s  "
        "iterations  diagonal s  iterations\n";
    for (const IterativeRow& row : rows) {
        text += fmt::format(
            "  {:10}  {:11}  {:7}  {}  {:2}  {:8}  {:10.2f}  {:8.3f}  {:8.3f}  {:10}  {:10.3f}  "
            "{:>10}\n",
            row.problem, row.geometry, row.n_patches, row.degree, row.n_elements, row.n_unknowns,
            row.assembly_seconds, row.setup_seconds, row.solve_seconds, row.iterations,
            row.jacobi_seconds,
            row.jacobi_iterations > 0 ? fmt::format("{}", row.jacobi_iterations) : "> 5000");
    }
    return text;
}

}  // namespace couture::drivers
