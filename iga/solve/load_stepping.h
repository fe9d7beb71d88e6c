#pragma once

#include <functional>
#include <map>

#include "iga/mechanics/problem.h"
#include "iga/solve/newton.h"
#include "iga/topology/field.h"

namespace couture::iga {

struct SteppingOptions {
    /// Time at which the run ends; loads that do not name t grow linearly until then.
    double end = 1.0;
    double first_step = 0.1;
    double smallest_step = 1e-4;
    double largest_step = 0.25;
    NewtonOptions newton;
    /// Gauss points per direction and element; nothing: degree + 1 of the space.
    std::optional<int> n_gauss_points;
};

/// An equilibrium on the way.
template <int d>
struct AcceptedStep {
    double t = 0.0;
    /// The step that led here, and the steps that were tried before and given up.
    double step = 0.0;
    int n_cuts = 0;
    NewtonReport newton;
    MatrixX displacement;
    /// Integral of the stored energy.
    double energy = 0.0;
    /// Sum of the dead loads, and what the supports exert, 3 components.
    Vector3 applied_force = Vector3::Zero();
    std::map<std::string, Vector3> reactions;
    /// Step that is tried next.
    double next_step = 0.0;
};

/// Where a run goes on from.
struct SteppingState {
    double t = 0.0;
    /// 0: `first_step`.
    double next_step = 0.0;
    /// n_dofs x d; empty: undeformed.
    MatrixX displacement;
};

struct SteppingReport {
    bool finished = false;
    double t = 0.0;
    int n_steps = 0;
    int n_cuts = 0;
    int n_iterations = 0;
    /// Why it stopped before the end.
    std::string reason;
};

/// Follows the equilibrium of a hyperelastic body in time. A step that Newton gives up is cut to a
/// half, not below `smallest_step`; after quick ones the next is larger.
///
/// @param accept  called after each accepted step, in order
/// @throws InputError, TopologyError  as `solve_linear_static`; also for load cases and
///                                    temperatures, which a stepped run does not have
template <int d>
[[nodiscard]] SteppingReport follow_loads(const SpacePtr<d>& space, const Problem& problem,
                                          const SteppingOptions& options,
                                          const std::function<void(const AcceptedStep<d>&)>& accept,
                                          const SteppingState& from = {});

}  // namespace couture::iga
