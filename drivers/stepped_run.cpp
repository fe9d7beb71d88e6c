#include "drivers/stepped_run.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "drivers/field_series.h"
#include "drivers/job_geometry.h"
#include "drivers/job_summary.h"
#include "drivers/probes.h"
#include "drivers/remesher.h"
#include "drivers/state_series.h"
#include "iga/assembly/elasticity.h"
#include "iga/assembly/loads.h"
#include "iga/core/error.h"
#include "iga/core/log.h"
#include "iga/core/text_hash.h"
#include "iga/solve/static_system.h"
#include "io/atomic_file.h"

namespace couture::drivers {

namespace {

/// Times this close, relative to the end of the run, are equal.
constexpr double time_rounding = 1e-9;

template <int d>
class SteppedRun {
  public:
    SteppedRun(const io::Deck& deck, const iga::MultiPatch<d>& geometry,
               const GeometryCertificate& certificate, const std::filesystem::path& folder)
        : deck_(deck),
          geometry_(geometry),
          locations_(locate_probes<d>(deck, geometry)),
          space_(make_space<d>(deck, geometry)),
          remeshing_(make_remeshing<d>(deck, space_->geometry())),
          start_(iga::make_start<d>(space_)),
          states_(folder / "states", state_origin(deck, iga::signature(geometry)),
                  start_.reference),
          fields_(deck, geometry, certificate, folder) {
        last_.state = start_;
        io::remove_leftovers(folder, deck.path.stem().string());
        io::remove_leftovers(states_.folder(), "");
    }

    [[nodiscard]] const iga::Space<d>& space() const { return *space_; }
    [[nodiscard]] const SteppingSummary& stepping() const { return stepping_; }
    [[nodiscard]] const iga::AcceptedStep<d>& last() const { return last_; }

    /// What an earlier run left is removed when this one has a step of its own to write.
    void start() { has_old_files_ = true; }

    void resume() {
        std::vector<iga::AcceptedStep<d>> steps = states_.read_all();
        if (steps.empty()) {
            log::info(fmt::format("{}: there is no state to go on from; the run starts at t = 0",
                                  states_.folder().string()));
            start();
            return;
        }
        for (const iga::AcceptedStep<d>& step : steps) {
            add(step);
        }
        last_ = std::move(steps.back());
        log::info(fmt::format("resumed at t = {:g} after step {}", last_.state.t, last_.number));
        guard([&] { complete_fields(); });
    }

    void run() {
        if (is_at_end()) {
            log::info(
                fmt::format("the run had already ended at t = {:g}; its results are written "
                            "again",
                            last_.state.t));
            stepping_.finished = true;
            guard([&] { fields_.write(last_); });
        } else {
            follow();
        }
        guard([&] { finish_fields(); });
    }

    [[nodiscard]] std::vector<ProbeResult> probes() const {
        std::vector<ProbeResult> results;
        for (std::size_t i = 0; i < deck_.probes.size(); ++i) {
            const io::Probe& probe = deck_.probes[i];
            const std::optional<iga::AcceptedStep<d>> step = step_of(probe);
            if (!step) {
                log::warn(fmt::format("{}: no step ended at t = {:g}", probe.source, *probe.t));
            }
            results.push_back(probe_result(
                probe, step ? quantity_of<d>(deck_, deck_.problem, *step, probe, place_of(i, *step))
                            : std::numeric_limits<double>::quiet_NaN()));
        }
        return results;
    }

    [[nodiscard]] std::vector<std::filesystem::path> files() const {
        std::vector<std::filesystem::path> result = fields_.files();
        result.push_back(states_.folder());
        return result;
    }

  private:
    [[nodiscard]] bool is_at_end() const {
        const iga::SteppingOptions& options = deck_.stepping;
        return last_.state.t >= options.end * (1.0 - time_rounding) ||
               (options.control == iga::Control::arc_length && last_.number >= options.max_steps);
    }

    void add(const iga::AcceptedStep<d>& step) {
        stepping_.history.push_back(to_summary<d>(step));
        stepping_.n_cuts += step.n_cuts;
    }

    void follow() {
        const int cuts_before = stepping_.n_cuts;
        const iga::SteppingReport report = iga::follow_loads<d>(
            last_.state, deck_.problem, deck_.stepping,
            [&](const iga::AcceptedStep<d>& step) { guard([&] { keep(step); }); }, remeshing_);
        stepping_.finished = report.finished;
        stepping_.reason = report.reason;
        if (!report.finished) {
            // With those of the step that was given up at last.
            stepping_.n_cuts = cuts_before + report.n_cuts;
        }
    }

    void remove_old_files() {
        has_old_files_ = false;
        if (const int n = states_.clear(); n > 0) {
            log::info(
                fmt::format("{}: {} states of an earlier run removed (--resume would have "
                            "gone on from them)",
                            states_.folder().string(), n));
        }
        fields_.clear();
    }

    void keep(const iga::AcceptedStep<d>& step) {
        if (has_old_files_) {
            remove_old_files();
        }
        const StepSummary record = to_summary<d>(step);
        // The state comes last: what it is there for is there, too.
        if (fields_.is_due(record)) {
            fields_.write(step);
        }
        states_.write(step);
        add(step);
        last_ = step;
        fields_.write_lists(stepping_.history);
        if (step.remeshing) {
            log::info(fmt::format("meshed again at t = {:.6g} ({}), {} iterations", record.t,
                                  step.remeshing->cause, step.remeshing->n_iterations));
            return;
        }
        log::info(
            fmt::format("step {}: t = {:.6g} of {:g}, step {:.3g}, {} iterations, {} cuts, "
                        "det F >= {:.4g}",
                        record.number, record.t, deck_.stepping.end, record.step,
                        record.n_iterations, record.n_cuts, record.min_det_F));
    }

    /// Writes fields that are due but not there: the deck may ask for more than it did.
    void complete_fields() {
        for (const StepSummary& record : stepping_.history) {
            if (fields_.is_due(record) && !fields_.has(record)) {
                fields_.write(states_.read(record.number, record.remeshing.has_value()));
            }
        }
    }

    void finish_fields() {
        // The last step is written even if it is none of those that are due.
        if (!stepping_.history.empty() && !fields_.has(stepping_.history.back())) {
            fields_.write(last_);
        }
        fields_.write_lists(stepping_.history);
        if (deck_.output.png) {
            fields_.draw(last_);
        }
    }

    /// Says what is kept when files can't be written.
    template <typename Action>
    void guard(const Action& action) const {
        try {
            action();
        } catch (const FileError& error) {
            throw SolverError(
                "{}; {} steps until t = {:g} are kept in {}: see to the folder, then go on with "
                "--resume",
                error.what(), stepping_.n_steps(), last_.state.t, states_.folder().string());
        }
    }

    /// The step that a probe asks for; nothing if none ended at its time.
    [[nodiscard]] std::optional<iga::AcceptedStep<d>> step_of(const io::Probe& probe) const {
        if (!probe.t) {
            return last_;
        }
        const auto found = std::find_if(
            stepping_.history.begin(), stepping_.history.end(), [&](const StepSummary& step) {
                return std::abs(step.t - *probe.t) <= time_rounding * deck_.stepping.end;
            });
        if (found == stepping_.history.end()) {
            return {};
        }
        return states_.read(found->number, found->remeshing.has_value());
    }

    /// Where the material point of a probe lies in the step's mesh.
    [[nodiscard]] std::optional<iga::Location<d>> place_of(std::size_t i_probe,
                                                           const iga::AcceptedStep<d>& step) const {
        const std::optional<iga::Location<d>>& location = locations_[i_probe];
        if (!location || step.state.n_remeshings == 0) {
            return location;
        }
        Vector3 point = Vector3::Zero();
        point.head<d>() = geometry_.patches[location->patch].point(location->xi);
        return iga::Locator<d>(step.state.reference->undeformed()->geometry()).nearest(point).first;
    }

    const io::Deck& deck_;
    const iga::MultiPatch<d>& geometry_;
    std::vector<std::optional<iga::Location<d>>> locations_;
    iga::SpacePtr<d> space_;
    iga::Remeshing<d> remeshing_;
    iga::SteppingState<d> start_;
    StateSeries<d> states_;
    FieldSeries<d> fields_;
    SteppingSummary stepping_;
    bool has_old_files_ = false;
    iga::AcceptedStep<d> last_;
};

template <int d>
CaseSummary case_of(const io::Deck& deck, const iga::AcceptedStep<d>& last) {
    CaseSummary result;
    result.energy = last.energy;
    result.applied_force = last.applied_force;
    result.reactions = last.reactions;
    if (!deck.problem.foundations.empty()) {
        const SparseMatrix springs = iga::assemble_foundations<d>(
            *last.state.reference->undeformed(), deck.problem, deck.discretization.n_gauss_points);
        result.foundation_force = -iga::sum_of_components(
            iga::unflatten(springs * iga::flatten(last.state.displacement), d));
    }
    Vector3 sum = result.applied_force + result.foundation_force;
    double largest = std::max(result.applied_force.norm(), result.foundation_force.norm());
    for (const auto& [set, force] : result.reactions) {
        sum += force;
        largest = std::max(largest, force.norm());
    }
    if (deck.problem.kinematics == iga::Kinematics::axisymmetric) {
        sum[0] = 0.0;  // hoop stress carries radial loads
    }
    result.balance = largest > 0.0 ? sum.norm() / largest : 0.0;
    return result;
}

template <int d>
int count_elements(const iga::Space<d>& space) {
    int n = 0;
    for (int p = 0; p < space.n_patches(); ++p) {
        int of_patch = 1;
        for (const iga::KnotVector& knots : space.tensor(p).knots) {
            of_patch *= knots.n_elements();
        }
        n += of_patch;
    }
    return n;
}

}  // namespace

io::StateOrigin state_origin(const io::Deck& deck, const std::string& signature) {
    io::StateOrigin origin{deck.path.filename().string(), text_hash(deck.model_text), signature, "",
                           ""};
    if (!deck.geometry.file.empty()) {
        origin.geometry_file = deck.geometry.file.filename().string();
        origin.geometry_hash = text_hash(io::read_text(deck.geometry.file));
    }
    return origin;
}

template <int d>
StepSummary to_summary(const iga::AcceptedStep<d>& step) {
    return {step.number,
            step.state.t,
            step.step,
            step.newton.iterations,
            step.n_cuts,
            step.newton.residuals.empty() ? 0.0 : step.newton.residuals.back(),
            step.energy,
            step.state.work,
            step.newton.min_det_F,
            step.applied_force,
            step.reactions,
            step.remeshing};
}

template <int d>
Summary run_stepped(const io::Deck& deck, const iga::MultiPatch<d>& geometry,
                    const GeometryCertificate& certificate, const std::filesystem::path& folder,
                    bool resume, std::vector<Phase> phases) {
    Timer timer;
    const auto end_phase = [&](const std::string& name) {
        phases.push_back({name, timer.seconds(), peak_memory()});
        timer = {};
    };
    SteppedRun<d> run(deck, geometry, certificate, folder);
    end_phase("discretization");
    const int n_unknowns = d * run.space().n_dofs();
    log::info(fmt::format("solving for {} unknowns", n_unknowns));
    if (resume) {
        run.resume();
    } else {
        run.start();
    }
    run.run();
    end_phase("load steps");

    Summary summary = describe_job<d>(deck, geometry, certificate);
    summary.probes = run.probes();
    end_phase("probes");
    for (const auto& file : run.files()) {
        summary.files.push_back(file.string());
    }
    summary.volume = iga::body_volume(deck.problem, run.space().geometry());
    summary.n_elements = count_elements<d>(run.space());
    summary.n_unknowns = n_unknowns;
    summary.stepping = run.stepping();
    summary.solver.solver = "newton, " + deck.solver.name;
    summary.solver.iterations = summary.stepping->n_iterations();
    if (!summary.stepping->history.empty()) {
        summary.solver.residual = summary.stepping->history.back().residual;
    }
    summary.cases = {case_of<d>(deck, run.last())};
    summary.phases = std::move(phases);
    summary.warnings = log::warnings();
    return summary;
}

template StepSummary to_summary(const iga::AcceptedStep<2>&);
template StepSummary to_summary(const iga::AcceptedStep<3>&);
template Summary run_stepped<2>(const io::Deck&, const iga::MultiPatch<2>&,
                                const GeometryCertificate&, const std::filesystem::path&, bool,
                                std::vector<Phase>);
template Summary run_stepped<3>(const io::Deck&, const iga::MultiPatch<3>&,
                                const GeometryCertificate&, const std::filesystem::path&, bool,
                                std::vector<Phase>);

}  // namespace couture::drivers
