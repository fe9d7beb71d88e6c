#include "iga/solve/load_stepping.h"

#include <algorithm>

#include "iga/assembly/loads.h"
#include "iga/core/error.h"
#include "iga/core/log.h"
#include "iga/solve/static_system.h"

namespace couture::iga {

namespace {

/// Steps that took at most so many iterations are followed by larger ones.
constexpr int quick_iterations = 5;
constexpr double growth = 1.5;

void check_options(const SteppingOptions& options) {
    const auto require = [](bool holds, const std::string& what) {
        if (!holds) {
            throw InputError("load steps: {}", what);
        }
    };
    require(options.end > 0.0, fmt::format("end = {:g}; must be positive", options.end));
    require(
        options.smallest_step > 0.0 && options.smallest_step <= options.first_step &&
            options.first_step <= options.largest_step,
        fmt::format("smallest {:g}, first {:g}, largest {:g}; must be positive and not decrease",
                    options.smallest_step, options.first_step, options.largest_step));
}

void check_problem(const Problem& problem) {
    const std::vector<std::string> cases = problem.load_cases();
    if (cases.size() != 1 || !cases.front().empty() || !problem.combinations.empty()) {
        throw InputError(
            "load case '{}': hyperelastic bodies are loaded along one path in time; leave load "
            "cases and combinations out",
            cases.front().empty() ? problem.combinations.begin()->first : cases.front());
    }
    if (!problem.temperatures.empty()) {
        const std::string& source = problem.temperatures.front().source;
        throw InputError(
            "{}temperature: hyperelastic materials have no thermal strain; leave it out",
            source.empty() ? "" : source + ": ");
    }
}

}  // namespace

template <int d>
SteppingState<d> make_start(const SpacePtr<d>& space) {
    SteppingState<d> start;
    start.reference = make_reference<d>(space);
    start.displacement = MatrixX::Zero(space->n_dofs(), d);
    return start;
}

template <int d>
SteppingReport follow_loads(const SteppingState<d>& from, const Problem& problem,
                            const SteppingOptions& options,
                            const std::function<void(const AcceptedStep<d>&)>& accept,
                            const Remeshing<d>& /*remeshing*/) {
    check_options(options);
    check_problem(problem);
    const SpacePtr<d>& space = from.reference->space;
    const SparseMatrix foundations = assemble_foundations(*space, problem, options.n_gauss_points);
    require_held(*space, problem, make_constraints(*space, problem, {""}), foundations);
    FiniteStrain<d> body(space, problem, options.n_gauss_points);
    Newton<d> newton(*space, body, foundations, options.n_gauss_points, options.newton);

    SteppingReport report;
    SteppingState<d> state = from;
    report.t = state.t;
    double step = state.next_step > 0.0 ? state.next_step : options.first_step;
    int n_cuts = 0;
    // Equal up to the rounding of a sum of steps.
    const double end = options.end * (1.0 - 1e-12);
    while (state.t < end) {
        const double t = state.t + step < end ? state.t + step : options.end;
        const Problem now = at_time(problem, t, options.end);
        const Constraints<d> constraints = make_constraints(*space, now, {""});
        Problem dead = now;
        std::erase_if(dead.pressures, [](const Pressure& load) { return load.follows_body; });
        const MatrixX dead_loads = assemble_loads(*space, dead, "", options.n_gauss_points);
        AcceptedStep<d> accepted;
        accepted.newton = newton.solve(constraints, dead_loads, now, state.displacement);
        report.n_iterations += accepted.newton.iterations;
        if (!accepted.newton.converged) {
            log::info(fmt::format("t = {:.6g}: step {:.3g} given up: {}", t, t - state.t,
                                  accepted.newton.reason));
            if (step <= options.smallest_step) {
                report.reason = fmt::format(
                    "no equilibrium at t = {:.6g} with the smallest step "
                    "{:g} from t = {:.6g}: {}",
                    t, step, state.t, accepted.newton.reason);
                return report;
            }
            step = std::max(0.5 * (t - state.t), options.smallest_step);
            ++n_cuts;
            ++report.n_cuts;
            continue;
        }
        accepted.step = t - state.t;
        accepted.n_cuts = n_cuts;
        accepted.energy = body.energy();
        accepted.applied_force = sum_of_components(newton.external_forces());
        accepted.reactions = support_reactions(problem, constraints, newton.residual());
        state.t = report.t = t;
        accepted.number = ++report.n_steps;
        if (n_cuts == 0 && accepted.newton.iterations <= quick_iterations) {
            step = std::min(growth * step, options.largest_step);
        }
        n_cuts = 0;
        state.next_step = step;
        accepted.state = state;
        accept(accepted);
    }
    report.finished = true;
    return report;
}

template SteppingState<2> make_start(const SpacePtr<2>&);
template SteppingState<3> make_start(const SpacePtr<3>&);
template SteppingReport follow_loads<2>(const SteppingState<2>&, const Problem&,
                                        const SteppingOptions&,
                                        const std::function<void(const AcceptedStep<2>&)>&,
                                        const Remeshing<2>&);
template SteppingReport follow_loads<3>(const SteppingState<3>&, const Problem&,
                                        const SteppingOptions&,
                                        const std::function<void(const AcceptedStep<3>&)>&,
                                        const Remeshing<3>&);

}  // namespace couture::iga
