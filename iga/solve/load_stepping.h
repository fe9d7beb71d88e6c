#pragma once

#include <functional>
#include <map>

#include "iga/assembly/reference_configuration.h"
#include "iga/mechanics/problem.h"
#include "iga/solve/newton.h"
#include "iga/solve/state_transfer.h"
#include "iga/topology/field.h"

namespace couture::iga {

enum class Control {
    /// Time is given; loads and prescribed displacements follow it.
    load,
    /// Time is an unknown, the length of the step in displacements and time is given: passes limit
    /// points. Source: [Crisfield91] Sec. 9.3.
    arc_length
};

struct SteppingOptions {
    Control control = Control::load;
    /// Time at which the run ends; loads that do not name t grow linearly until then.
    double end = 1.0;
    /// Of time. Arc length: the first step has the length that this one has, later ones are bounded
    /// by the lengths of the others to it.
    double first_step = 0.1;
    double smallest_step = 1e-4;
    double largest_step = 0.25;
    /// Accepted steps after which a run ends; 0: no limit. An arc-length run needs one.
    int max_steps = 0;
    /// Times that a step ends at, whatever its length: corners of tables, probes. Ascending.
    std::vector<double> stops;
    NewtonOptions newton;
    /// Gauss points per direction and element; nothing: degree + 1 of the space.
    std::optional<int> n_gauss_points;
    Volumetric volumetric = Volumetric::automatic;
};

/// Where a run is, and where it goes on from.
template <int d>
struct SteppingState {
    double t = 0.0;
    /// Step that is tried next; 0: `first_step`. Arc length: its length.
    double next_step = 0.0;
    ReferencePtr<d> reference;
    /// Total displacement, n_dofs x d of the reference's space; empty: undeformed.
    MatrixX displacement;
    /// Work that loads and supports have done on the body.
    double work = 0.0;
    /// Arc length, see `PathPoint`.
    MatrixX direction;
    double time_direction = 0.0;
    double displacement_scale = 0.0;
    /// Accepted steps so far, remeshings among them not counted.
    int n_steps = 0;
    /// How often the body was meshed again, and when last.
    int n_remeshings = 0;
    double last_remeshing = -1.0;
    /// False once a remeshing could not bring the quality within its limits.
    bool watches_quality = true;
};

/// What a remeshing did, before and after.
struct RemeshingReport {
    double t = 0.0;
    /// "time", "shape ratio 5.2 > 5", "Newton failed", ...
    std::string cause;
    /// What was carried over: `gradient` also where that was the only way.
    Transfer transfer = Transfer::displacement;
    /// Stored energy on the old mesh, on the new one with what was transferred, and there in
    /// equilibrium.
    double energy_before = 0.0;
    double energy_transferred = 0.0;
    double energy_after = 0.0;
    /// Of the deformed body.
    double volume_before = 0.0;
    double volume_after = 0.0;
    std::map<std::string, Vector3> reactions_before;
    std::map<std::string, Vector3> reactions_after;
    /// Of the deformed body: worst of the shape ratio S_r, the scaled Jacobian and Q_h.
    double shape_ratio_before = 0.0;
    double shape_ratio_after = 0.0;
    double scaled_jacobian_before = 0.0;
    double scaled_jacobian_after = 0.0;
    double angle_deviation_before = 0.0;
    double angle_deviation_after = 0.0;
    /// |F_b - F| over |F - I| in L2, F_b the projected deformation gradient and F that of the
    /// transferred displacement.
    double gradient_drift = 0.0;
    double min_det_F = 1.0;
    /// Farthest that a point whose values were carried over lay outside the old mesh, a length.
    double largest_gap = 0.0;
    /// Newton iterations to the equilibrium on the new mesh.
    int n_iterations = 0;
};

/// An equilibrium on the way.
template <int d>
struct AcceptedStep {
    SteppingState<d> state;
    /// Number of the step, from 1; a remeshing has that of the step it follows.
    int number = 0;
    /// The step in time that led here, and the steps that were tried before and given up.
    double step = 0.0;
    int n_cuts = 0;
    NewtonReport newton;
    /// Integral of the stored energy.
    double energy = 0.0;
    /// Sum of the loads, and what the supports exert, 3 components.
    Vector3 applied_force = Vector3::Zero();
    std::map<std::string, Vector3> reactions;
    /// Set where the body was meshed again here: the state is the equilibrium on the new mesh.
    std::optional<RemeshingReport> remeshing;
};

/// When the body is meshed again, and how.
template <int d>
struct Remeshing {
    /// The deformed body in, the same body in better elements out, with an equal signature.
    /// @throws Error  if it can't; the run then goes on with the old mesh, as it does where the new
    ///                one is no better
    std::function<MultiPatch<d>(const MultiPatch<d>& deformed)> mesh;
    /// At these times, ascending.
    std::vector<double> times;
    /// When the deformed body is worse: largest shape ratio S_r, smallest scaled Jacobian, largest
    /// Q_h.
    std::optional<double> shape_ratio;
    std::optional<double> scaled_jacobian;
    std::optional<double> angle_deviation;
    /// When Newton fails with the smallest step.
    bool on_failure = false;
    Transfer transfer = Transfer::displacement;
    int max_remeshings = 20;
};

struct SteppingReport {
    bool finished = false;
    double t = 0.0;
    int n_steps = 0;
    int n_cuts = 0;
    int n_iterations = 0;
    int n_remeshings = 0;
    /// Why it stopped before the end.
    std::string reason;
};

/// Follows the equilibrium of a hyperelastic body in time. A step that Newton gives up is cut to a
/// half, not below `smallest_step`; after quick ones the next is larger.
///
/// @param from  the start; an empty displacement: undeformed
/// @param accept  called after each accepted step, in order, and after each remeshing; what it
///                throws ends the run
/// @param remeshing  without `mesh`: never
/// @param share  where several processes have some elements each, see `Equilibrium`
/// @throws InputError, TopologyError  as `solve_linear_static`; also for load cases and
///                                    temperatures, which a stepped run does not have
template <int d>
[[nodiscard]] SteppingReport follow_loads(const SteppingState<d>& from, const Problem& problem,
                                          const SteppingOptions& options,
                                          const std::function<void(const AcceptedStep<d>&)>& accept,
                                          const Remeshing<d>& remeshing = {},
                                          BodyShare<d>* share = nullptr);

/// The undeformed body.
template <int d>
[[nodiscard]] SteppingState<d> make_start(const SpacePtr<d>& space);

}  // namespace couture::iga
