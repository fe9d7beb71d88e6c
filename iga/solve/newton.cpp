#include "iga/solve/newton.h"

#include <algorithm>
#include <cmath>

#include "iga/assembly/follower_pressure.h"
#include "iga/assembly/sparsity.h"
#include "iga/core/error.h"
#include "iga/core/format.h"
#include "iga/core/log.h"
#include "iga/linalg/cholmod_solver.h"
#include "iga/solve/static_system.h"

namespace couture::iga {

namespace {

constexpr int max_halvings = 8;
/// Share of the residual, or of its work on the step, that may be left after a step.
constexpr double sufficient_decrease = 0.95;
/// Forces below this share of |tangent| |u| are rounding.
constexpr double rounding = 1e-14;

/// Norm over the free unknowns.
double free_norm(const VectorX& r, const std::vector<char>& is_fixed) {
    double sum = 0.0;
    for (Eigen::Index i = 0; i < r.size(); ++i) {
        sum += is_fixed[i] != 0 ? 0.0 : r[i] * r[i];
    }
    return std::sqrt(sum);
}

double free_dot(const VectorX& a, const VectorX& b, const std::vector<char>& is_fixed) {
    double sum = 0.0;
    for (Eigen::Index i = 0; i < a.size(); ++i) {
        sum += is_fixed[i] != 0 ? 0.0 : a[i] * b[i];
    }
    return sum;
}

double largest_entry(const Buffer<double>& values) {
    double largest = 0.0;
    for (const double value : values) {
        largest = std::max(largest, std::abs(value));
    }
    return largest;
}

}  // namespace

template <int d>
Newton<d>::Newton(const Space<d>& space, FiniteStrain<d>& body, const SparseMatrix& foundations,
                  std::optional<int> n_gauss_points, const NewtonOptions& options)
    : space_(space),
      body_(body),
      foundations_(foundations),
      n_gauss_points_(n_gauss_points),
      options_(options),
      solver_(make_linear_solver(options.solver)),
      matrix_(make_pattern(space, d)) {}

template <int d>
VectorX Newton<d>::internal_forces(const MatrixX& u) const {
    VectorX forces = flatten(body_.internal_forces());
    if (foundations_.nonZeros() > 0) {
        forces += foundations_ * flatten(u);
    }
    return forces;
}

template <int d>
MatrixX Newton<d>::solve_tangent(const std::vector<char>& is_fixed, const MatrixX& b) {
    MatrixX x;
    try {
        // Ordered once: the pattern stays.
        solver_->factorize({matrix_, is_fixed, {}});
        solver_->solve(b, x);
    } catch (const NotPositiveDefinite& error) {
        log::detail("the tangent is indefinite, LU instead of Cholesky");
        SolverOptions options = options_.solver;
        options.name = "umfpack";
        const std::unique_ptr<LinearSolver> lu = make_linear_solver(options);
        lu->factorize({matrix_, is_fixed, {}});
        lu->solve(b, x);
    }
    return x;
}

template <int d>
NewtonReport Newton<d>::solve(const Constraints<d>& constraints, const MatrixX& dead_loads,
                              const Problem& problem, MatrixX& u) {
    NewtonReport report;
    const std::vector<char>& is_fixed = constraints.is_fixed;
    MatrixX now = flatten(u);
    constraints.to_frames(now);
    FollowerPressure follower;
    // External forces in the frames.
    VectorX f;
    SmallestVolume<d> smallest;
    VectorX forces;
    // Moves the body; false if it is folded there.
    const auto move_to = [&](const MatrixX& unknowns) {
        MatrixX global = unknowns;
        constraints.to_global(global);
        const MatrixX rows = unflatten(global.col(0), d);
        smallest = body_.deform(rows);
        if (!(smallest.det_F > 0.0)) {
            return false;
        }
        follower = assemble_follower_pressure(space_, problem, rows, n_gauss_points_);
        external_ = dead_loads + follower.forces;
        MatrixX both(now.rows(), 2);
        both << internal_forces(rows), flatten(external_);
        constraints.to_frames(both);
        forces = both.col(0);
        f = both.col(1);
        return forces.allFinite();
    };
    const auto fail = [&](const std::string& why) {
        report.reason = why;
        return report;
    };

    if (!move_to(now)) {
        return fail(fmt::format("the start is folded: det F = {:.3g} in patch {} at {}",
                                smallest.det_F, smallest.patch, format_point(smallest.xi)));
    }
    double floor = 0.0;
    for (;; ++report.iterations) {
        const VectorX r = forces - f;
        VectorX jump = VectorX::Zero(r.size());
        for (Eigen::Index i = 0; i < r.size(); ++i) {
            if (is_fixed[i] != 0) {
                jump[i] = constraints.values(i, 0) - now(i, 0);
            }
        }
        const bool has_jump = jump.cwiseAbs().maxCoeff() > 0.0;
        const double scale = std::max(f.norm(), forces.norm());
        const double size = free_norm(r, is_fixed);
        report.residuals.push_back(scale > 0.0 ? size / scale : 0.0);
        log::detail(fmt::format("newton {}: residual {:.2e}, det F >= {:.3g}", report.iterations,
                                report.residuals.back(), smallest.det_F));
        if (!has_jump && size <= std::max(options_.tolerance * scale, floor)) {
            constraints.to_global(now);
            u = unflatten(now.col(0), d);
            residual_ = r;
            report.converged = true;
            report.min_det_F = smallest.det_F;
            return report;
        }
        if (report.iterations == options_.max_iterations) {
            return fail(fmt::format("|r|/|f| = {:.1e} > {:.0e} after {} iterations",
                                    report.residuals.back(), options_.tolerance,
                                    report.iterations));
        }

        body_.tangent(matrix_);
        add_symmetric(matrix_, foundations_);
        add_symmetric(matrix_, follower.stiffness);
        rotate_to_frames(matrix_, constraints);
        floor = rounding * largest_entry(matrix_.values) * now.norm();
        MatrixX step;
        try {
            step = solve_tangent(is_fixed, -r - matrix_ * MatrixX(jump));
        } catch (const SolverError& error) {
            return fail(error.what());
        }
        step += jump;
        if (!step.allFinite()) {
            return fail("the linear system has no finite solution");
        }

        const MatrixX start = now;
        const double work = free_dot(r, step.col(0), is_fixed);
        double share = 1.0;
        int halvings = 0;
        for (;; ++halvings, share *= 0.5) {
            now = start + share * step;
            if (share == 1.0) {
                // Exactly what is prescribed.
                for (Eigen::Index i = 0; i < r.size(); ++i) {
                    now(i, 0) = is_fixed[i] != 0 ? constraints.values(i, 0) : now(i, 0);
                }
            }
            if (move_to(now)) {
                const VectorX trial = forces - f;
                // Supports that move raise the residual: nothing to compare with.
                if (has_jump || free_norm(trial, is_fixed) <= sufficient_decrease * size ||
                    std::abs(free_dot(trial, step.col(0), is_fixed)) <=
                        sufficient_decrease * std::abs(work) ||
                    free_norm(trial, is_fixed) <= floor) {
                    break;
                }
            }
            if (halvings == max_halvings) {
                return fail(smallest.det_F > 0.0
                                ? fmt::format("no step along the search direction lowers the "
                                              "residual {:.1e}",
                                              report.residuals.back())
                                : fmt::format("det F = {:.3g} in patch {} at {}", smallest.det_F,
                                              smallest.patch, format_point(smallest.xi)));
            }
        }
    }
}

template class Newton<2>;
template class Newton<3>;

}  // namespace couture::iga
