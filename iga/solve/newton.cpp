#include "iga/solve/newton.h"

#include <algorithm>
#include <cmath>

#include "iga/core/error.h"
#include "iga/core/format.h"
#include "iga/core/log.h"

namespace couture::iga {

namespace {

constexpr int max_halvings = 8;
/// A share of a step must lower the residual, or its work on the step, by this part of that share:
/// to first order it falls by all of it.
constexpr double sufficient_decrease = 0.05;
/// Forces below this share of |tangent| |u| are rounding.
constexpr double rounding = 1e-14;
/// Step in time, relative to it, for the derivative of the loads: exact where they are linear.
constexpr double time_difference = 1e-4;

template <int d>
std::string fold(const Equilibrium<d>& body) {
    const SmallestVolume<d>& at = body.smallest_volume();
    if (at.det_F > 0.5) {
        return std::string("the forces are not finite");
    }
    return fmt::format("det F = {:.3g} in patch {} at {}", at.det_F, at.patch, format_point(at.xi));
}

/// One iteration is noted; true if the residual is small enough.
template <int d>
bool note_residual(const Equilibrium<d>& body, const LoadState<d>& loads,
                   const NewtonOptions& options, double floor, NewtonReport& report) {
    const double scale =
        std::max(body.norm(body.external_forces()), body.norm(body.internal_forces()));
    const double size = body.norm(body.residual(), &loads.constraints.is_fixed);
    report.residuals.push_back(scale > 0.0 ? size / scale : 0.0);
    report.min_det_F = body.smallest_volume().det_F;
    log::detail(fmt::format("newton {}: residual {:.2e}, det F >= {:.3g}", report.iterations,
                            report.residuals.back(), report.min_det_F));
    return std::isfinite(scale) && size <= std::max(options.tolerance * scale, floor);
}

std::string not_converged(const NewtonReport& report, const NewtonOptions& options) {
    return fmt::format("|r|/|f| = {:.1e} > {:.0e} after {} iterations", report.residuals.back(),
                       options.tolerance, report.iterations);
}

}  // namespace

template <int d>
NewtonReport solve_newton(Equilibrium<d>& body, const LoadState<d>& loads,
                          const NewtonOptions& options, MatrixX& displacement) {
    NewtonReport report;
    const Constraints<d>& constraints = loads.constraints;
    const std::vector<char>& is_fixed = constraints.is_fixed;
    MatrixX now = to_unknowns(constraints, displacement);
    const auto fail = [&](const std::string& why) {
        report.reason = why;
        return report;
    };
    if (!body.move_to(loads, now)) {
        return fail("the start is folded: " + fold(body));
    }
    double floor = 0.0;
    for (;; ++report.iterations) {
        const VectorX r = body.residual();
        VectorX jump = VectorX::Zero(r.size());
        for (Eigen::Index i = 0; i < r.size(); ++i) {
            if (is_fixed[i] != 0) {
                jump[i] = constraints.values(i, 0) - now(i, 0);
            }
        }
        const bool has_jump = body.largest(jump) > 0.0;
        const double size = body.norm(r, &is_fixed);
        if (note_residual(body, loads, options, floor, report) && !has_jump) {
            displacement = body.displacement();
            report.converged = true;
            return report;
        }
        if (report.iterations == options.max_iterations) {
            return fail(not_converged(report, options));
        }

        body.linearize(loads);
        floor = rounding * body.stiffness_scale() * body.norm(now.col(0));
        MatrixX step;
        try {
            step = body.solve(loads, has_jump ? MatrixX(-r - body.apply(jump)) : MatrixX(-r));
        } catch (const SolverError& error) {
            return fail(error.what());
        }
        step += jump;
        if (!std::isfinite(body.norm(step.col(0)))) {
            return fail("the linear system has no finite solution");
        }

        const MatrixX start = now;
        const double work = body.dot(r, step.col(0), &is_fixed);
        double share = 1.0;
        for (int halvings = 0;; ++halvings, share *= 0.5) {
            now = start + share * step;
            if (share == 1.0) {
                // Exactly what is prescribed.
                for (Eigen::Index i = 0; i < r.size(); ++i) {
                    now(i, 0) = is_fixed[i] != 0 ? constraints.values(i, 0) : now(i, 0);
                }
            }
            const bool is_unfolded = body.move_to(loads, now);
            if (is_unfolded) {
                const VectorX trial = body.residual();
                const double left = 1.0 - sufficient_decrease * share;
                // Supports that move raise the residual: nothing to compare with.
                const double trial_size = body.norm(trial, &is_fixed);
                const double trial_work = body.dot(trial, step.col(0), &is_fixed);
                if (has_jump || trial_size <= left * size ||
                    std::abs(trial_work) <= left * std::abs(work) || trial_size <= floor) {
                    break;
                }
            }
            if (halvings == max_halvings) {
                return fail(is_unfolded ? fmt::format("no step along the search direction lowers "
                                                      "the residual {:.1e}",
                                                      report.residuals.back())
                                        : fold(body));
            }
        }
    }
}

template <int d>
NewtonReport solve_arc_step(Equilibrium<d>& body, const NewtonOptions& options, double length,
                            PathPoint<d>& point) {
    NewtonReport report;
    const auto fail = [&](const std::string& why) {
        report.reason = why;
        return report;
    };
    LoadState<d> loads = body.loads_at(point.t);
    const std::vector<char>& is_fixed = loads.constraints.is_fixed;
    const MatrixX start = to_unknowns(loads.constraints, point.displacement);
    MatrixX now = start;
    double t = point.t;
    double scale = point.displacement_scale;
    double dt = 0.0;
    double floor = 0.0;
    if (!body.move_to(loads, now)) {
        return fail("the start is folded: " + fold(body));
    }
    for (;; ++report.iterations) {
        const VectorX r = body.residual();
        const bool is_start = report.iterations == 0;
        VectorX jump = VectorX::Zero(r.size());
        for (Eigen::Index i = 0; i < r.size(); ++i) {
            jump[i] = is_fixed[i] != 0 ? loads.constraints.values(i, 0) - now(i, 0) : 0.0;
        }
        if (note_residual(body, loads, options, floor, report) && !is_start &&
            body.largest(jump) == 0.0) {
            point.t = t;
            point.direction = body.displacement() - point.displacement;
            point.time_direction = dt;
            point.displacement = body.displacement();
            point.displacement_scale = scale;
            report.converged = true;
            return report;
        }
        if (report.iterations == options.max_iterations) {
            return fail(not_converged(report, options));
        }
        // Change of loads and supports with time, at this place.
        body.linearize(loads);
        floor = rounding * body.stiffness_scale() * body.norm(now.col(0));
        const double h = time_difference * std::max(length, std::abs(t));
        const LoadState<d> later = body.loads_at(t + h);
        MatrixX support_rate = (later.constraints.values - loads.constraints.values) / h;
        const VectorX external = body.external_forces();
        if (!body.move_to(later, now)) {
            return fail(fold(body));
        }
        const VectorX load_rate = (body.external_forces() - external) / h;
        MatrixX rhs(r.size(), 2);
        rhs << -r - body.apply(jump), load_rate - body.apply(support_rate);
        MatrixX solutions;
        try {
            solutions = body.solve(loads, rhs);
        } catch (const SolverError& error) {
            return fail(error.what());
        }
        const VectorX a = solutions.col(0) + jump;
        const VectorX b = solutions.col(1) + support_rate.col(0);
        const double b_norm = body.norm(b);
        if (!std::isfinite(body.norm(a)) || !std::isfinite(b_norm) || b_norm == 0.0) {
            return fail("the linear system has no finite solution, or nothing depends on time");
        }
        if (scale == 0.0) {
            scale = b_norm;
        }
        double step_t = 0.0;
        if (is_start) {
            step_t = length / std::sqrt(0.5 * (b_norm * b_norm / (scale * scale) + 1.0));
            if (point.direction.size() > 0) {
                const MatrixX before = to_unknowns(loads.constraints, point.direction);
                const double ahead =
                    body.dot(b, before.col(0)) / (scale * scale) + point.time_direction;
                step_t = ahead < 0.0 ? -step_t : step_t;
            }
        } else {
            const VectorX moved = (now - start).col(0);
            const double gap =
                0.5 * (body.dot(moved, moved) / (scale * scale) + dt * dt) - length * length;
            const double slope = body.dot(moved, b) / (scale * scale) + dt;
            if (slope == 0.0) {
                return fail("the path turns back within one step");
            }
            step_t = -(gap + body.dot(moved, a) / (scale * scale)) / slope;
        }
        const MatrixX before = now;
        const double dt_before = dt;
        double share = 1.0;
        for (int halvings = 0;; ++halvings, share *= 0.5) {
            now = before + share * (a + step_t * b);
            dt = dt_before + share * step_t;
            t = point.t + dt;
            loads = body.loads_at(t);
            for (Eigen::Index i = 0; share == 1.0 && i < now.rows(); ++i) {
                now(i, 0) = is_fixed[i] != 0 ? loads.constraints.values(i, 0) : now(i, 0);
            }
            if (body.move_to(loads, now)) {
                break;
            }
            if (halvings == max_halvings) {
                return fail(fold(body));
            }
        }
    }
}

template NewtonReport solve_newton(Equilibrium<2>&, const LoadState<2>&, const NewtonOptions&,
                                   MatrixX&);
template NewtonReport solve_newton(Equilibrium<3>&, const LoadState<3>&, const NewtonOptions&,
                                   MatrixX&);
template NewtonReport solve_arc_step(Equilibrium<2>&, const NewtonOptions&, double, PathPoint<2>&);
template NewtonReport solve_arc_step(Equilibrium<3>&, const NewtonOptions&, double, PathPoint<3>&);

}  // namespace couture::iga
