#include "drivers/distributed_steps.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "drivers/field_series.h"
#include "drivers/probes.h"
#include "drivers/state_series.h"
#include "drivers/stepped_run.h"
#include "iga/assembly/loads.h"
#include "iga/core/error.h"
#include "iga/core/log.h"
#include "iga/distributed/distributed_body.h"
#include "iga/distributed/distributed_static.h"
#include "iga/solve/static_system.h"

namespace couture::drivers {

namespace {

template <int d>
class RankSteps {
  public:
    RankSteps(const DistributedJob<d>& job, Summary& summary)
        : job_(job),
          deck_(job.deck),
          summary_(summary),
          start_(iga::make_start<d>(job.space.pieces.space)),
          states_(job.folder / "states" / fmt::format("rank_{:04}", job.ranks.rank()), origin(),
                  start_.reference),
          fields_(deck_, job.geometry.geometry(), job.certificate, job.folder, ".pvtu"),
          body_(job.ranks, job.geometry, job.space, petsc_options(),
                deck_.stepping.n_gauss_points) {
        last_.state = start_;
        summary_.stepping.emplace();
    }

    void resume() {
        std::vector<iga::AcceptedStep<d>> steps;
        job_.ranks.together([&] { steps = states_.read_all(); });
        // A rank that was killed may lack the last.
        const double n_all = -job_.ranks.max(-static_cast<double>(steps.size()));
        steps.resize(static_cast<std::size_t>(n_all));
        if (steps.empty()) {
            log::info("there is no state of all ranks to go on from; the run starts at t = 0");
            return;
        }
        for (const iga::AcceptedStep<d>& step : steps) {
            add(step);
        }
        job_.ranks.together([&] { last_ = states_.read(steps.back().number, false); });
        log::info(fmt::format("resumed at t = {:g} after step {}", last_.state.t, last_.number));
    }

    void start() {
        job_.ranks.together([&] {
            (void)states_.clear();
            if (job_.ranks.rank() == 0) {
                fields_.clear();
            }
        });
    }

    void run() {
        SteppingSummary& stepping = *summary_.stepping;
        if (is_at_end()) {
            stepping.finished = true;
        } else {
            const iga::SteppingReport report = iga::follow_loads<d>(
                last_.state, deck_.problem, stepping_options(),
                [&](const iga::AcceptedStep<d>& step) { keep(step); }, {}, &body_);
            stepping.finished = report.finished;
            stepping.reason = report.reason;
        }
        if (deck_.output.vtu && !stepping.history.empty()) {
            write_fields(last_);
            write_lists();
            summary_.files.push_back(fields_.files().front().string());
        }
        summary_.files.push_back(states_.folder().parent_path().string());
    }

    void describe() {
        for (std::size_t i = 0; i < deck_.probes.size(); ++i) {
            summary_.probes.push_back(probe_result(deck_.probes[i], value_of(i)));
        }
        summary_.solver.solver = "newton, petsc";
        summary_.solver.iterations = summary_.stepping->n_iterations();
        if (!summary_.stepping->history.empty()) {
            summary_.solver.residual = summary_.stepping->history.back().residual;
        }
        CaseSummary whole;
        whole.energy = last_.energy;
        whole.applied_force = last_.applied_force;
        whole.reactions = last_.reactions;
        Vector3 ground = Vector3::Zero();
        job_.ranks.together([&] {
            const SparseMatrix springs = iga::assemble_foundations<d>(
                *job_.space.pieces.space, job_.on_pieces, deck_.discretization.n_gauss_points);
            ground = -iga::sum_of_components(
                iga::unflatten(springs * iga::flatten(last_.state.displacement), d));
        });
        whole.foundation_force = job_.ranks.sum(MatrixX(ground));
        whole.balance = iga::force_balance(deck_.problem, whole.applied_force, whole.reactions,
                                           whole.foundation_force, 0.0);
        summary_.cases = {whole};
    }

  private:
    [[nodiscard]] iga::SolverOptions petsc_options() const {
        if (deck_.solver.name != "auto" && deck_.solver.name != "petsc") {
            throw InputError(
                "{}: linear = \"{}\" of [solver] is for one process; hyperelastic runs of several "
                "ranks take \"petsc\" (or \"auto\", the same)",
                deck_.path.string(), deck_.solver.name);
        }
        iga::SolverOptions options = deck_.solver;
        options.name = "petsc";
        // The share of a Newton step: what is left of it is in the next residual.
        constexpr double newton_step = 1e-8;
        options.tolerance = std::max(options.tolerance, newton_step);
        return options;
    }

    [[nodiscard]] iga::SteppingOptions stepping_options() const {
        iga::SteppingOptions options = deck_.stepping;
        options.newton.solver = petsc_options();
        return options;
    }

    [[nodiscard]] io::StateOrigin origin() const {
        io::StateOrigin result = state_origin(deck_, iga::signature(job_.geometry.geometry()));
        result.signature += fmt::format(", rank {} of {}", job_.ranks.rank(), job_.ranks.size());
        return result;
    }

    [[nodiscard]] bool is_at_end() const {
        constexpr double time_rounding = 1e-9;
        const iga::SteppingOptions& options = deck_.stepping;
        return last_.state.t >= options.end * (1.0 - time_rounding) ||
               (options.control == iga::Control::arc_length && last_.number >= options.max_steps);
    }

    void add(const iga::AcceptedStep<d>& step) {
        summary_.stepping->history.push_back(to_summary<d>(step));
        summary_.stepping->n_cuts += step.n_cuts;
    }

    void keep(const iga::AcceptedStep<d>& step) {
        add(step);
        const StepSummary& record = summary_.stepping->history.back();
        if (deck_.output.vtu && fields_.is_due(record)) {
            write_fields(step);
        }
        job_.ranks.together([&] { states_.write(step); });
        last_ = step;
        write_lists();
        log::info(fmt::format(
            "step {}: t = {:.6g} of {:g}, step {:.3g}, {} iterations, {} cuts, det F >= {:.4g}",
            record.number, record.t, deck_.stepping.end, record.step, record.n_iterations,
            record.n_cuts, record.min_det_F));
    }

    void write_lists() const {
        job_.ranks.together([&] {
            if (job_.ranks.rank() == 0) {
                fields_.write_lists(summary_.stepping->history);
            }
        });
    }

    void write_fields(const iga::AcceptedStep<d>& step) const {
        MatrixX integrals;
        job_.ranks.together([&] { integrals = stresses_of(step).integrals(); });
        const auto fields =
            iga::FiniteFields::from(iga::project<d>(job_.ranks, job_.space, integrals));
        job_.write_pieces(deck_.path.stem().string() + "_" + step_name(step.number, false),
                          field_arrays(step.state.displacement, fields));
    }

    [[nodiscard]] iga::FiniteStresses<d> stresses_of(const iga::AcceptedStep<d>& step) const {
        return {job_.on_pieces, step.state, deck_.stepping.n_gauss_points,
                deck_.stepping.volumetric};
    }

    [[nodiscard]] double value_of(std::size_t i_probe) const {
        const io::Probe& probe = deck_.probes[i_probe];
        iga::AcceptedStep<d> step = last_;
        if (probe.t) {
            constexpr double time_rounding = 1e-9;
            const std::vector<StepSummary>& history = summary_.stepping->history;
            const auto found =
                std::find_if(history.begin(), history.end(), [&](const StepSummary& one) {
                    return std::abs(one.t - *probe.t) <= time_rounding * deck_.stepping.end;
                });
            if (found == history.end()) {
                log::warn(fmt::format("{}: no step ended at t = {:g}", probe.source, *probe.t));
                return std::numeric_limits<double>::quiet_NaN();
            }
            job_.ranks.together([&] { step = states_.read(found->number, false); });
        }
        const std::optional<iga::Location<d>>& place = job_.locations[i_probe];
        if (!place && probe.quantity != "volume") {
            return quantity_of<d>(deck_, job_.on_pieces, step, probe, {});
        }
        double share = 0.0;
        job_.ranks.together([&] {
            const auto here = place ? job_.here(*place) : std::nullopt;
            if (here || !place) {
                share = quantity_of<d>(deck_, job_.on_pieces, step, probe, here);
            }
        });
        return job_.ranks.sum(share);
    }

    const DistributedJob<d>& job_;
    const io::Deck& deck_;
    Summary& summary_;
    iga::SteppingState<d> start_;
    StateSeries<d> states_;
    FieldSeries<d> fields_;
    iga::DistributedBody<d> body_;
    iga::AcceptedStep<d> last_;
};

}  // namespace

template <int d>
void follow_on_ranks(const DistributedJob<d>& job, bool resume, Summary& summary) {
    std::optional<RankSteps<d>> steps;
    job.ranks.together([&] {
        if (job.deck.remeshing) {
            throw InputError(
                "{}: [remeshing] works in one process only; leave it out, or start "
                "without mpirun",
                job.deck.path.string());
        }
        steps.emplace(job, summary);
    });
    if (resume) {
        steps->resume();
    } else {
        steps->start();
    }
    steps->run();
    steps->describe();
}

template void follow_on_ranks(const DistributedJob<2>&, bool, Summary&);
template void follow_on_ranks(const DistributedJob<3>&, bool, Summary&);

}  // namespace couture::drivers
