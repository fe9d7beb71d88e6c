#pragma once

#include <string>
#include <vector>

#include "iga/solve/equilibrium.h"

namespace couture::iga {

struct NewtonOptions {
    /// Largest accepted |residual| over |forces|, both over all free, and all, unknowns.
    double tolerance = 1e-9;
    int max_iterations = 20;
    SolverOptions solver;
};

struct NewtonReport {
    bool converged = false;
    /// Linear systems solved.
    int iterations = 0;
    /// |residual| over |forces| before each of them and at the end.
    std::vector<double> residuals;
    /// Where the body is compressed most at the end: det F.
    double min_det_F = 1.0;
    /// What stopped it, if it did not converge.
    std::string reason;
};

/// Equilibrium under given loads by Newton's method with a backtracking line search: a step is
/// halved while det F <= 0 somewhere, or while neither the residual nor its work on the step falls.
///
/// @param displacement  n_dofs x d: the start; the equilibrium, if it is found, else unchanged
template <int d>
[[nodiscard]] NewtonReport solve_newton(Equilibrium<d>& body, const LoadState<d>& loads,
                                        const NewtonOptions& options, MatrixX& displacement);

/// A point of a path of equilibria, and its tangent there.
template <int d>
struct PathPoint {
    double t = 0.0;
    /// n_dofs x d.
    MatrixX displacement;
    /// Of the last step, in displacements and time; empty: along growing time.
    MatrixX direction;
    double time_direction = 0.0;
    /// |du / dt| where the path began: what displacements are measured by; 0: not yet known.
    double displacement_scale = 0.0;
};

/// One step along a path of equilibria, through limit points of the load: displacement and time
/// move so that 1/2 (|du| / scale)^2 + 1/2 dt^2 = length^2.
///
/// @param point  the start; the new point, if it is found, else unchanged
///
/// Source: [Crisfield91] Sec. 9.3. Differs: the constraint is linearised in each iteration like the
/// equilibrium, as all loads and supports may depend on time in any way.
template <int d>
[[nodiscard]] NewtonReport solve_arc_step(Equilibrium<d>& body, const NewtonOptions& options,
                                          double length, PathPoint<d>& point);

}  // namespace couture::iga
