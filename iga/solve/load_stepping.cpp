#include "iga/solve/load_stepping.h"

#include <algorithm>

#include "iga/core/error.h"
#include "iga/core/format.h"
#include "iga/core/log.h"
#include "iga/solve/state_transfer.h"
#include "iga/solve/static_system.h"
#include "iga/topology/element_quality.h"

namespace couture::iga {

namespace {

/// Steps that took at most so many iterations are followed by larger ones.
constexpr int quick_iterations = 5;
constexpr double growth = 1.5;
/// Smallest step over the end of the run.
constexpr double least_step = 1e-10;
/// Of the missing forces on a new mesh, that are taken off at once.
constexpr double smallest_relaxation = 1e-3;
/// Times are equal up to the rounding of a sum of steps, relative to the end.
constexpr double same_time = 1e-12;

void check_options(const SteppingOptions& options) {
    const auto require = [](bool holds, const std::string& what) {
        if (!holds) {
            throw InputError("load steps: {}", what);
        }
    };
    require(options.control == Control::load || options.max_steps > 0,
            "an arc-length run may never reach its end; give max_steps");
    require(options.end > 0.0, fmt::format("end = {:g}; must be positive", options.end));
    require(options.smallest_step >= least_step * options.end,
            fmt::format("smallest {:g}; must be at least {:g} of the end, {:g}: time could not "
                        "tell such steps apart",
                        options.smallest_step, least_step, options.end));
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

/// What one mesh of the deformed body is worth.
struct MeshQuality {
    double shape_ratio = 0.0;
    double scaled_jacobian = 1.0;
    double angle_deviation = 0.0;
};

template <int d>
MeshQuality quality_of(const MultiPatch<d>& body) {
    const QualitySummary<d> summary = element_quality(body);
    return {summary.max_shape_ratio, summary.min_scaled_jacobian, summary.max_angle_deviation};
}

/// A run from one state to its end.
template <int d>
class Stepper {
  public:
    Stepper(const SteppingState<d>& from, const Problem& problem, const SteppingOptions& options,
            const std::function<void(const AcceptedStep<d>&)>& accept,
            const Remeshing<d>& remeshing, BodyShare<d>* share)
        : state_(from),
          problem_(problem),
          options_(options),
          accept_(accept),
          remeshing_(remeshing),
          share_(share),
          stops_(options.stops) {
        if (state_.displacement.size() == 0) {
            state_.displacement = MatrixX::Zero(state_.reference->space->n_dofs(), d);
        }
        stops_.insert(stops_.end(), remeshing.times.begin(), remeshing.times.end());
        stops_.push_back(options.end);
        std::sort(stops_.begin(), stops_.end());
        if (remeshing_.mesh && !state_.reference->space->is_isoparametric()) {
            // Says what to do; better now than after hours.
            static_cast<void>(deformed_body(*state_.reference, state_.displacement));
        }
        take_reference(state_.reference);
        report_.t = state_.t;
        step_ = state_.next_step > 0.0 ? state_.next_step : options.first_step;
    }

    SteppingReport run() {
        if (!find_start()) {
            return report_;
        }
        while (!is_at(options_.end)) {
            if (is_remeshing_due()) {
                // A new mesh is a help, not a need: without it the run goes on with the old one.
                static_cast<void>(remesh(due_to_));
            }
            if (options_.max_steps > 0 && state_.n_steps >= options_.max_steps) {
                report_.finished = options_.control == Control::arc_length;
                report_.reason = fmt::format("max_steps = {} are done at t = {:.6g}",
                                             options_.max_steps, state_.t);
                return report_;
            }
            if (!advance()) {
                return report_;
            }
        }
        report_.finished = true;
        return report_;
    }

  private:
    [[nodiscard]] bool is_at(double time) const {
        return std::abs(state_.t - time) <= same_time * options_.end;
    }

    void take_reference(ReferencePtr<d> reference) {
        state_.reference = std::move(reference);
        body_ = std::make_unique<Equilibrium<d>>(state_.reference, problem_, options_.end,
                                                 options_.n_gauss_points, options_.volumetric,
                                                 options_.newton.solver, share_);
    }

    /// Forces at the start, for the work of the first step.
    bool find_start() {
        const LoadState<d> loads = body_->loads_at(state_.t);
        if (!body_->move_to(loads, to_unknowns(loads.constraints, state_.displacement))) {
            const SmallestVolume<d>& at = body_->smallest_volume();
            report_.reason = fmt::format("the start is folded: det F = {:.3g} in patch {} at {}",
                                         at.det_F, at.patch, format_point(at.xi));
            return false;
        }
        note_forces(loads);
        return true;
    }

    void note_forces(const LoadState<d>& loads) {
        forces_ = to_displacement(loads.constraints, body_->internal_forces());
        reactions_ = body_->reactions(loads);
        energy_ = body_->energy();
    }

    /// The next time under load control.
    [[nodiscard]] double target() const {
        const double slack = same_time * options_.end;
        const double t = state_.t + step_;
        for (const double stop : stops_) {
            if (stop > state_.t + slack && stop <= t + slack) {
                return stop;
            }
        }
        return t;
    }

    /// One accepted step; false at the end of what can be reached.
    bool advance() {
        int n_cuts = 0;
        for (;;) {
            SteppingState<d> next = state_;
            NewtonReport newton;
            double planned = step_;
            if (options_.control == Control::load) {
                next.t = target();
                planned = next.t - state_.t;
                newton = solve_newton(*body_, body_->loads_at(next.t), options_.newton,
                                      next.displacement);
            } else {
                newton = arc_step(next);
            }
            report_.n_iterations += newton.iterations;
            if (newton.converged) {
                if (n_cuts == 0 && newton.iterations <= quick_iterations) {
                    step_ = std::min(growth * step_, options_.largest_step);
                }
                take(next, newton, n_cuts);
                return true;
            }
            log::info(fmt::format("t = {:.6g}: step {:.3g} given up: {}", state_.t, planned,
                                  newton.reason));
            if (planned <= options_.smallest_step * (1.0 + same_time)) {
                if (remeshing_.mesh && remeshing_.on_failure && state_.t > state_.last_remeshing &&
                    state_.n_remeshings < remeshing_.max_remeshings) {
                    step_ = options_.first_step;
                    if (remesh("Newton failed")) {
                        return true;
                    }
                    report_.reason = fmt::format(
                        "no equilibrium beyond t = {:.6g} with the smallest step {:g}: {}; {}",
                        state_.t, planned, newton.reason, remeshing_fault_);
                    return false;
                }
                report_.reason =
                    fmt::format("no equilibrium beyond t = {:.6g} with the smallest step {:g}: {}",
                                state_.t, planned, newton.reason);
                return false;
            }
            step_ = std::max(0.5 * planned, options_.smallest_step);
            ++n_cuts;
            ++report_.n_cuts;
        }
    }

    NewtonReport arc_step(SteppingState<d>& next) {
        PathPoint<d> point{state_.t, state_.displacement, state_.direction, state_.time_direction,
                           state_.displacement_scale};
        NewtonReport newton = solve_arc_step(*body_, options_.newton, step_, point);
        if (newton.converged && point.t > options_.end) {
            // The end lies on the way.
            MatrixX u = state_.displacement + (options_.end - state_.t) / (point.t - state_.t) *
                                                  (point.displacement - state_.displacement);
            const NewtonReport last =
                solve_newton(*body_, body_->loads_at(options_.end), options_.newton, u);
            newton = last;
            point.t = options_.end;
            point.displacement = u;
        }
        next.t = point.t;
        next.displacement = point.displacement;
        next.direction = point.direction;
        next.time_direction = point.time_direction;
        next.displacement_scale = point.displacement_scale;
        return newton;
    }

    void take(const SteppingState<d>& next, const NewtonReport& newton, int n_cuts) {
        AcceptedStep<d> accepted;
        accepted.step = next.t - state_.t;
        accepted.n_cuts = n_cuts;
        accepted.newton = newton;
        const MatrixX before = forces_;
        const MatrixX moved = next.displacement - state_.displacement;
        state_ = next;
        note_forces(body_->loads_at(state_.t));
        state_.work += 0.5 * body_->dot(flatten(before + forces_), flatten(moved));
        state_.next_step = step_;
        ++state_.n_steps;
        report_.t = state_.t;
        ++report_.n_steps;
        publish(accepted);
    }

    void publish(AcceptedStep<d>& accepted) {
        accepted.number = state_.n_steps;
        accepted.energy = energy_;
        accepted.applied_force = body_->applied_force();
        accepted.reactions = reactions_;
        accepted.state = state_;
        accept_(accepted);
    }

    /// Fills `due_to_`.
    bool is_remeshing_due() {
        if (!remeshing_.mesh || !find_cause()) {
            return false;
        }
        if (state_.n_remeshings >= remeshing_.max_remeshings) {
            log::warn(fmt::format("a remeshing is due ({}), but max_remeshings = {} are done",
                                  due_to_, remeshing_.max_remeshings));
            state_.last_remeshing = state_.t;
            return false;
        }
        return true;
    }

    bool find_cause() {
        for (const double time : remeshing_.times) {
            if (is_at(time) && state_.last_remeshing < time - same_time * options_.end) {
                due_to_ = "time";
                return true;
            }
        }
        const bool watches =
            remeshing_.shape_ratio || remeshing_.scaled_jacobian || remeshing_.angle_deviation;
        if (!watches || !state_.watches_quality || !(state_.t > state_.last_remeshing)) {
            return false;
        }
        due_to_ = fault(quality_of(deformed_body(*state_.reference, state_.displacement)));
        return !due_to_.empty();
    }

    /// Which limit a quality misses; empty: none.
    [[nodiscard]] std::string fault(const MeshQuality& quality) const {
        if (remeshing_.shape_ratio && quality.shape_ratio > *remeshing_.shape_ratio) {
            return fmt::format("shape ratio {:.3g} > {:.3g}", quality.shape_ratio,
                               *remeshing_.shape_ratio);
        }
        if (remeshing_.scaled_jacobian && quality.scaled_jacobian < *remeshing_.scaled_jacobian) {
            return fmt::format("scaled Jacobian {:.3g} < {:.3g}", quality.scaled_jacobian,
                               *remeshing_.scaled_jacobian);
        }
        if (remeshing_.angle_deviation && quality.angle_deviation > *remeshing_.angle_deviation) {
            return fmt::format("angle deviation {:.3g} > {:.3g}", quality.angle_deviation,
                               *remeshing_.angle_deviation);
        }
        return {};
    }

    /// Equilibrium from a state that is none, where the body was moved to last: what it lacks acts
    /// as a load that is taken off, all at once or, where Newton fails, in steps.
    NewtonReport relax(const LoadState<d>& loads, int& n_iterations) {
        const MatrixX missing = to_displacement(loads.constraints, body_->residual());
        double left = 1.0;
        double step = 1.0;
        for (;;) {
            const double next = std::max(left - step, 0.0);
            LoadState<d> partial = loads;
            partial.dead_loads += next * missing;
            const NewtonReport newton =
                solve_newton(*body_, partial, options_.newton, state_.displacement);
            n_iterations += newton.iterations;
            log::detail(fmt::format("relaxation to {:.3g} of the missing forces: {}", next,
                                    newton.converged ? "done" : newton.reason));
            if (newton.converged && next == 0.0) {
                return newton;
            }
            if (newton.converged) {
                left = next;
                step *= growth;
            } else if (step < smallest_relaxation) {
                return newton;
            } else {
                step *= 0.5;
            }
        }
    }

    /// Goes over to a new mesh, in equilibrium at the same time. False if that failed, or did not
    /// better the elements: the old mesh and state stay, a warning says why.
    bool remesh(const std::string& cause) {
        RemeshingReport record;
        record.t = state_.t;
        record.cause = cause;
        const MultiPatch<d> old_mesh = deformed_body(*state_.reference, state_.displacement);
        const MeshQuality before = quality_of(old_mesh);
        const SteppingState<d> old_state = state_;
        const MatrixX old_forces = forces_;
        const std::map<std::string, Vector3> old_reactions = reactions_;
        const double old_energy = energy_;
        const auto fail = [&](const std::string& why) {
            remeshing_fault_ =
                fmt::format("remeshing at t = {:.6g} ({}) failed: {}", record.t, cause, why);
            if (state_.reference != old_state.reference) {
                take_reference(old_state.reference);
                const LoadState<d> loads = body_->loads_at(old_state.t);
                static_cast<void>(
                    body_->move_to(loads, to_unknowns(loads.constraints, old_state.displacement)));
            }
            state_ = old_state;
            state_.last_remeshing = state_.t;
            // Elements that could not be bettered once are not tried at every step.
            state_.watches_quality = state_.watches_quality && cause == "time";
            forces_ = old_forces;
            reactions_ = old_reactions;
            energy_ = old_energy;
            log::warn(remeshing_fault_ + "; the run goes on with the old mesh");
            return false;
        };
        try {
            const MultiPatch<d> mesh = remeshing_.mesh(old_mesh);
            if (signature(mesh) != signature(old_mesh)) {
                throw TopologyError(
                    "the new mesh has signature {}, the old one {}; they must be equal",
                    signature(mesh), signature(old_mesh));
            }
            TransferOptions options;
            options.n_gauss_points = options_.n_gauss_points;
            options.transfer = remeshing_.transfer;
            TransferredState<d> moved = transfer_state(*state_.reference, problem_.kinematics,
                                                       state_.displacement, mesh, options);
            record.energy_before = energy_;
            record.reactions_before = reactions_;
            record.volume_before = volume(old_mesh);
            record.gradient_drift = moved.gradient_drift;
            record.min_det_F = moved.min_det_F;
            record.largest_gap = moved.largest_gap;
            record.transfer = moved.transfer;
            if (moved.transfer != remeshing_.transfer) {
                log::warn(fmt::format(
                    "t = {:.6g}: the new mesh folds when it is moved back to the undeformed body; "
                    "the deformation gradient is carried over, too",
                    state_.t));
            }
            state_.displacement = moved.displacement;
            take_reference(moved.reference);
        } catch (const Error& error) {
            return fail(error.what());
        }
        const LoadState<d> loads = body_->loads_at(state_.t);
        if (!body_->move_to(loads, to_unknowns(loads.constraints, state_.displacement))) {
            return fail("the transferred state is folded");
        }
        record.energy_transferred = body_->energy();
        AcceptedStep<d> accepted;
        accepted.newton = relax(loads, record.n_iterations);
        report_.n_iterations += record.n_iterations;
        if (!accepted.newton.converged) {
            return fail("no equilibrium on the new mesh: " + accepted.newton.reason);
        }
        note_forces(loads);
        const MultiPatch<d> new_mesh = deformed_body(*state_.reference, state_.displacement);
        const MeshQuality after = quality_of(new_mesh);
        if (!(after.scaled_jacobian > 0.0) && after.scaled_jacobian < before.scaled_jacobian) {
            return fail(
                fmt::format("in equilibrium the new mesh has a scaled Jacobian of {:.3g}, "
                            "the old one {:.3g}",
                            after.scaled_jacobian, before.scaled_jacobian));
        }
        if (!(after.shape_ratio < before.shape_ratio) &&
            !(after.scaled_jacobian > before.scaled_jacobian)) {
            return fail(
                fmt::format("the new mesh is no better: worst shape ratio {:.3g}, was "
                            "{:.3g}, scaled Jacobian {:.3g}, was {:.3g}",
                            after.shape_ratio, before.shape_ratio, after.scaled_jacobian,
                            before.scaled_jacobian));
        }
        record.energy_after = energy_;
        record.reactions_after = reactions_;
        record.volume_after = volume(new_mesh);
        record.shape_ratio_before = before.shape_ratio;
        record.shape_ratio_after = after.shape_ratio;
        record.scaled_jacobian_before = before.scaled_jacobian;
        record.scaled_jacobian_after = after.scaled_jacobian;
        record.angle_deviation_before = before.angle_deviation;
        record.angle_deviation_after = after.angle_deviation;
        if (state_.watches_quality && !fault(after).empty() && cause != "time") {
            log::warn(
                fmt::format("t = {:.6g}: the new mesh still has {}; quality is no longer "
                            "watched",
                            state_.t, fault(after)));
            state_.watches_quality = false;
        }
        ++state_.n_remeshings;
        ++report_.n_remeshings;
        state_.last_remeshing = state_.t;
        state_.next_step = step_;
        state_.direction.resize(0, 0);
        log::info(fmt::format(
            "t = {:.6g}: meshed again ({}): worst shape ratio {:.3g} -> {:.3g}, "
            "scaled Jacobian {:.3g} -> {:.3g}, energy {:.6g} -> {:.6g}",
            record.t, cause, before.shape_ratio, after.shape_ratio, before.scaled_jacobian,
            after.scaled_jacobian, record.energy_before, record.energy_after));
        accepted.remeshing = record;
        publish(accepted);
        return true;
    }

    SteppingState<d> state_;
    const Problem& problem_;
    const SteppingOptions& options_;
    const std::function<void(const AcceptedStep<d>&)>& accept_;
    const Remeshing<d>& remeshing_;
    BodyShare<d>* share_;
    std::unique_ptr<Equilibrium<d>> body_;
    SteppingReport report_;
    double step_ = 0.0;
    /// At the last equilibrium: internal forces n_dofs x d, reactions, stored energy.
    MatrixX forces_;
    std::map<std::string, Vector3> reactions_;
    double energy_ = 0.0;
    std::string due_to_;
    std::string remeshing_fault_;
    std::vector<double> stops_;
};

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
                            const Remeshing<d>& remeshing, BodyShare<d>* share) {
    if (share != nullptr && remeshing.mesh) {
        throw InputError(
            "load steps: a body of which several processes have some elements each is not meshed "
            "again; leave [remeshing] out, or start one process");
    }
    check_options(options);
    check_problem(problem);
    return Stepper<d>(from, problem, options, accept, remeshing, share).run();
}

template SteppingState<2> make_start(const SpacePtr<2>&);
template SteppingState<3> make_start(const SpacePtr<3>&);
template SteppingReport follow_loads<2>(const SteppingState<2>&, const Problem&,
                                        const SteppingOptions&,
                                        const std::function<void(const AcceptedStep<2>&)>&,
                                        const Remeshing<2>&, BodyShare<2>*);
template SteppingReport follow_loads<3>(const SteppingState<3>&, const Problem&,
                                        const SteppingOptions&,
                                        const std::function<void(const AcceptedStep<3>&)>&,
                                        const Remeshing<3>&, BodyShare<3>*);

}  // namespace couture::iga
