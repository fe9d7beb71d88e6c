#include "verification/benchmarks/remeshing.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "iga/core/error.h"
#include "iga/post/finite_stress.h"
#include "iga/solve/load_stepping.h"
#include "iga/topology/locator.h"
#include "iga/topology/multipatch_interpolate.h"
#include "meshing/pipeline/remesh_solid.h"
#include "meshing/volume/optimize_volume.h"
#include "verification/problem_tools.h"

namespace couture::verification {

using namespace iga;

namespace {

constexpr double shear_modulus = 3.0;
constexpr double bulk_modulus = 20.0;
/// Ten digits of the reference value.
constexpr double homogeneous_bound = 1e-8;

constexpr const char* closed_form = "closed form, uniaxial stress";
constexpr const char* radial_equation = "radial equation, Runge-Kutta of order 4";

/// One patch with its inner control points moved smoothly by up to `size`: worth meshing again.
MultiPatch<3> stirred(const MultiPatch<3>& mesh, double size) {
    MultiPatch<3> result = mesh;
    const Patch<3>& patch = mesh.patches[0];
    MatrixX points = patch.control_points();
    const std::array<int, 3> sizes = patch.space().sizes();
    for (int i = 0; i < points.rows(); ++i) {
        const std::array<int, 3> at = patch.space().indices(i);
        double bump = size;
        for (int k = 0; k < 3; ++k) {
            bump *= std::sin(std::numbers::pi * at[k] / (sizes[k] - 1));
        }
        points.row(i) += bump * Eigen::RowVector3d(1.0, -0.8, 0.4);
    }
    result.patches[0] = Patch<3>(patch.space(), points, patch.weights());
    return result;
}

struct Run {
    SteppingState<3> last;
    RemeshingReport remeshing;
    std::map<std::string, Vector3> reactions;
};

/// From the undeformed body to the end, meshed again at t = 0.5.
Run run_remeshed(const MultiPatch<3>& mesh, const Problem& problem, Transfer transfer) {
    const auto space = std::make_shared<const Space<3>>(mesh);
    const meshing::BoundaryFeatures features(mesh);
    Remeshing<3> remeshing;
    remeshing.times = {0.5};
    remeshing.transfer = transfer;
    remeshing.mesh = [&](const MultiPatch<3>& body) {
        return meshing::optimize_volume(body, features).volume;
    };
    Run run;
    const SteppingReport report = follow_loads<3>(
        make_start<3>(space), problem, {},
        [&](const AcceptedStep<3>& step) {
            run.last = step.state;
            run.reactions = step.reactions;
            run.remeshing = step.remeshing.value_or(run.remeshing);
        },
        remeshing);
    if (!report.finished || report.n_remeshings != 1) {
        throw SolverError("the run ended at t = {} with {} remeshings: {}", report.t,
                          report.n_remeshings, report.reason);
    }
    return run;
}

/// F = F_f F_b at a stretch of 2, meshed again at 1.5.
void composition(Recorder& recorder) {
    recorder.set_source(closed_form);
    for (const int degree : {1, 2}) {
        Problem problem = neo_hookean_problem(Kinematics::solid, shear_modulus, bulk_modulus);
        problem.supports = {make_symmetry("x_low"), make_symmetry("y_low"), make_symmetry("z_low"),
                            make_support("x_high", 1.0, {}, {})};
        const Run run =
            run_remeshed(stirred(make_space<3>(part<3>("box"), degree, 4)->geometry(), 0.05),
                         problem, Transfer::gradient);
        const FiniteState state =
            FiniteStresses<3>(problem, run.last).at(0, Vector3(0.3, 0.6, 0.7));
        const std::string name = fmt::format("p={}: ", degree);
        recorder.relative(name + "Cauchy stress", 8.2946926763, state.state.stress[0],
                          homogeneous_bound);
        recorder.relative(name + "force", 4.7206957265, run.reactions.at("x_high")[0],
                          homogeneous_bound);
        recorder.relative(name + "lateral stretch", 0.7544020407, 1.0 + state.H(1, 1),
                          homogeneous_bound);
        recorder.vanishing(name + "energy lost in the transfer",
                           run.remeshing.energy_transferred / run.remeshing.energy_before - 1.0,
                           homogeneous_bound);
    }
}

/// A quarter of a tube of radii 1 and 2, its ends held: as the plane one without remeshing.
void inflated_tube(Recorder& recorder) {
    recorder.set_source(radial_equation);
    Problem problem = neo_hookean_problem(Kinematics::solid, shear_modulus, bulk_modulus);
    problem.supports = {make_symmetry("cut_x"), make_symmetry("cut_y"), make_symmetry("z_low"),
                        make_symmetry("z_high")};
    problem.pressures = {make_pressure("inner", 0.7906356787)};
    const MultiPatch<3> tube = make_space<3>(part<3>("thick_cylinder_3d", {{"length", 0.25}}), 2,
                                             std::array<int, 3>{8, 10, 3})
                                   ->geometry();
    for (const auto& [name, transfer] : {std::pair("displacement", Transfer::displacement),
                                         std::pair("F_b", Transfer::gradient)}) {
        const Run run = run_remeshed(stirred(tube, 0.12), problem, transfer);
        const Field<3> u{run.last.reference->undeformed(), run.last.displacement};
        const std::string carried = fmt::format("{} carried over: ", name);
        recorder.relative(carried + "inner radius", 1.25,
                          1.0 + displacement_at<3>(u, Vector3(1.0, 0.0, 0.125))[0], 1e-4);
        recorder.relative(carried + "outer radius", 2.1486155550,
                          2.0 + displacement_at<3>(u, Vector3(2.0, 0.0, 0.125))[0], 1e-4);
        recorder.relative(
            carried + "inner hoop stress", 1.81190212,
            FiniteStresses<3>(problem, run.last).at(0, Vector3(0.0, 0.0, 0.125)).state.stress[1],
            3e-2);
        recorder.vanishing(carried + "change of volume by the new mesh",
                           run.remeshing.volume_after / run.remeshing.volume_before - 1.0, 1e-4);
        recorder.vanishing(carried + "change of energy by the new mesh",
                           run.remeshing.energy_after / run.remeshing.energy_before - 1.0, 1e-3);
        recorder.absolute(
            carried + "worst shape ratio at most half", 1.0,
            run.remeshing.shape_ratio_after < 0.5 * run.remeshing.shape_ratio_before ? 1.0 : 0.0,
            0.0);
        recorder.vanishing(carried + "drift of F_b", run.remeshing.gradient_drift, 2e-2);
    }
}

/// The arm pushed in by s; its cap is guided, so that it does not buckle sideways.
Problem pushed_seal(double s, double sideways = 0.0, double kappa = bulk_modulus) {
    Problem problem = neo_hookean_problem(Kinematics::solid, shear_modulus, kappa);
    problem.supports = {make_support("cuts", 0.0, 0.0, 0.0),
                        make_support("cap", -s, sideways, 0.0)};
    return problem;
}

/// The smoothed stress of a state of the half seal.
class SealStress {
  public:
    SealStress(const Problem& problem, const SteppingState<3>& state)
        : stress_{FiniteStresses<3>(problem, state).undeformed(),
                  FiniteStresses<3>(problem, state).project().stress},
          locator_(stress_.space->geometry()) {}

    /// At a point of the undeformed body.
    [[nodiscard]] Vector<6> at(const Vector3& X) const {
        const Location<3> place = locator_.nearest(X).first;
        return stress_.value(place.patch, place.xi);
    }
    [[nodiscard]] const Space<3>& space() const { return *stress_.space; }

  private:
    Field<3> stress_;
    Locator<3> locator_;
};

/// |a - b| over |b| in L2 over the undeformed body, sampled at the middles of a's elements.
double stress_difference(const SealStress& a, const SealStress& b) {
    double difference = 0.0;
    double size = 0.0;
    for (const Patch<3>& patch : a.space().geometry().patches) {
        const std::array<int, 3> n = patch.space().n_elements();
        for (int e = 0; e < n[0] * n[1] * n[2]; ++e) {
            const std::array<int, 3> element = {e % n[0], e / n[0] % n[1], e / (n[0] * n[1])};
            Vector3 xi;
            double weight = 1.0;
            for (int k = 0; k < 3; ++k) {
                const std::vector<double>& knots = patch.knots(k).breakpoints();
                xi[k] = 0.5 * (knots[element[k]] + knots[element[k] + 1]);
                weight *= knots[element[k] + 1] - knots[element[k]];
            }
            weight *= std::abs(patch.jacobian(xi).determinant());
            const Vector3 X = patch.point(xi);
            difference += weight * (a.at(X) - b.at(X)).squaredNorm();
            size += weight * b.at(X).squaredNorm();
        }
    }
    return std::sqrt(difference / size);
}

MultiPatch<3> seal_mesh(int divisions, int degree) {
    return interpolate<3>(part<3>("half_seal", {{"divisions", static_cast<double>(divisions)}}),
                          degree, {});
}

struct SealRun {
    SteppingReport report;
    SteppingState<3> last;
    std::optional<RemeshingReport> remeshing;
    int most_iterations = 0;
};

/// Control points slide, or the deformed boundary is mapped to the layout anew.
enum class Mesher { slide, surface };

SealRun run_seal(const MultiPatch<3>& mesh, const Problem& problem, std::vector<double> remeshings,
                 Mesher mesher = Mesher::slide) {
    SteppingOptions options;
    options.first_step = options.largest_step = 0.05;
    const meshing::BoundaryFeatures features(mesh);
    Remeshing<3> remeshing;
    remeshing.times = std::move(remeshings);
    remeshing.mesh = [&](const MultiPatch<3>& body) {
        return mesher == Mesher::surface ? meshing::remesh_solid(body, features).volume
                                         : meshing::optimize_volume(body, features).volume;
    };
    SealRun run;
    run.report = follow_loads<3>(
        make_start<3>(std::make_shared<const Space<3>>(mesh)), problem, options,
        [&](const AcceptedStep<3>& step) {
            run.last = step.state;
            run.most_iterations = std::max(run.most_iterations, step.newton.iterations);
            if (step.remeshing) {
                run.remeshing = step.remeshing;
            }
        },
        remeshing);
    return run;
}

/// A run that must reach its end.
SealRun finished_seal(Recorder& recorder, const std::string& name, const MultiPatch<3>& mesh,
                      const Problem& problem, const std::vector<double>& remeshings,
                      Mesher mesher = Mesher::slide) {
    SealRun run = run_seal(mesh, problem, remeshings, mesher);
    if (!run.report.finished) {
        throw SolverError("{}", run.report.reason);
    }
    recorder.absolute(name + ": most Newton iterations in a step (at most 6)", 3.0,
                      run.most_iterations, 3.0);
    return run;
}

/// What a new mesh may change.
void record_remeshing(Recorder& recorder, const std::string& name, const RemeshingReport& report) {
    recorder.absolute(name + ": worst shape ratio, part left (at most 0.7)", 0.35,
                      report.shape_ratio_after / report.shape_ratio_before, 0.35);
    recorder.vanishing(name + ": change of energy by the new mesh",
                       report.energy_after / report.energy_before - 1.0, 0.01);
    recorder.vanishing(name + ": change of volume by the new mesh",
                       report.volume_after / report.volume_before - 1.0, 0.01);
}

/// 3 mm from the middle of the upper and of the side re-entrant edge and from the corner where they
/// meet.
std::vector<std::pair<std::string, Vector3>> seal_points() {
    return {{"upper edge", {37.88, 0.5, 4.38}},
            {"side edge", {35.71, 10.88, 0.5}},
            {"corner", {36.10, 11.27, 4.77}}};
}

/// Against the same elements not meshed again.
void record_stresses(Recorder& recorder, const std::string& name, const SealStress& plain,
                     const SealStress& again) {
    for (const auto& [place, X] : seal_points()) {
        recorder.relative(place + ": von Mises, " + name + " against not", von_mises(plain.at(X)),
                          von_mises(again.at(X)), 0.02);
    }
    recorder.vanishing("stress field in L2, " + name + " against not",
                       stress_difference(again, plain), 0.2);
}

/// Meshed again half-way, against a finer mesh that is not.
void half_seal(Recorder& recorder) {
    recorder.set_source("degree 2, 1152 elements, not meshed again");
    const Problem problem = pushed_seal(26.0);
    const auto run = [&](const std::string& name, const MultiPatch<3>& mesh,
                         const std::vector<double>& remeshings, Mesher mesher = Mesher::slide) {
        return finished_seal(recorder, name, mesh, problem, remeshings, mesher);
    };
    const SealStress fine(problem, run("p=2, not meshed again", seal_mesh(2, 2), {}).last);
    const SealStress fine_again(problem, run("p=2, meshed again", seal_mesh(2, 2), {0.5}).last);
    const SealStress plain(problem, run("p=1, not meshed again", seal_mesh(3, 1), {}).last);
    const std::vector<std::pair<std::string, Mesher>> meshers = {
        {"p=1, meshed again", Mesher::slide},
        {"p=1, meshed again from its surface", Mesher::surface}};
    for (const auto& [place, X] : seal_points()) {
        const double expected = von_mises(fine.at(X));
        recorder.relative(place + ": von Mises, p=2, meshed again", expected,
                          von_mises(fine_again.at(X)), 0.02);
        recorder.relative(place + ": von Mises, p=1, not meshed again", expected,
                          von_mises(plain.at(X)), 0.15);
    }
    recorder.vanishing("stress field in L2, p=2, meshed again", stress_difference(fine_again, fine),
                       0.2);
    recorder.vanishing("stress field in L2, p=1, not meshed again", stress_difference(plain, fine),
                       0.4);
    for (const auto& [name, mesher] : meshers) {
        const SealRun remeshed = run(name, seal_mesh(3, 1), {0.5}, mesher);
        record_remeshing(recorder, name, remeshed.remeshing.value());
        const SealStress again(problem, remeshed.last);
        for (const auto& [place, X] : seal_points()) {
            recorder.relative(place + ": von Mises, " + name, von_mises(fine.at(X)),
                              von_mises(again.at(X)), 0.15);
        }
        recorder.vanishing("stress field in L2, " + name, stress_difference(again, fine), 0.4);
        record_stresses(recorder, name, plain, again);
    }
}

/// As half_seal on elements of degree 1 alone, more compressible.
void half_seal_kappa_10(Recorder& recorder) {
    recorder.set_source("degree 1, 3888 elements, not meshed again");
    const Problem problem = pushed_seal(26.0, 0.0, 10.0);
    const MultiPatch<3> mesh = seal_mesh(3, 1);
    const SealStress plain(problem,
                           finished_seal(recorder, "not meshed again", mesh, problem, {}).last);
    const std::vector<std::pair<std::string, Mesher>> meshers = {
        {"meshed again", Mesher::slide}, {"meshed again from its surface", Mesher::surface}};
    for (const auto& [name, mesher] : meshers) {
        const SealRun remeshed = finished_seal(recorder, name, mesh, problem, {0.5}, mesher);
        record_remeshing(recorder, name, remeshed.remeshing.value());
        record_stresses(recorder, name, plain, SealStress(problem, remeshed.last));
    }
}

/// Pushed in by 75 and sideways by 1 mm, through the buckling of the ring and the folding of its
/// sides: the same steps, 1e-4 the smallest.
void half_seal_far(Recorder& recorder) {
    recorder.set_source("1152 elements of degree 1, meshed again at t = 0.3 or not");
    const Problem problem = pushed_seal(75.0, 1.0);
    const SealRun plain = run_seal(seal_mesh(2, 1), problem, {});
    const SealRun again = run_seal(seal_mesh(2, 1), problem, {0.3});
    recorder.absolute("not meshed again: reaches its end", 0.0, plain.report.finished ? 1.0 : 0.0,
                      0.0);
    recorder.absolute("not meshed again: stops at t", 0.99, plain.report.t, 0.0099);
    recorder.absolute("meshed again: reaches its end", 1.0, again.report.finished ? 1.0 : 0.0, 0.0);
}

/// Radii 1 and 2, inner pressure: the largest that it bears, and a state beyond.
void limit_point(Recorder& recorder) {
    recorder.set_source(radial_equation);
    MultiPatch<2> meridian = part<2>("half_annulus");
    const Interface<2>& equator = meridian.interfaces.at(0);
    meridian.boundary_sets["equator"] = {make_side<2>(equator.first_patch, equator.first_side)};
    Problem problem = neo_hookean_problem(Kinematics::axisymmetric, shear_modulus, bulk_modulus);
    problem.supports = {make_support("axis", 0.0, {}), make_support("equator", {}, 0.0)};
    constexpr double pressure = 3.0;
    problem.pressures = {make_pressure("inner", pressure)};
    const SpacePtr<2> space = make_space<2>(meridian, 3, {8, 4});
    SteppingOptions options;
    options.control = Control::arc_length;
    options.max_steps = 40;
    std::vector<Vector2> path{Vector2(1.0, 0.0)};
    const SteppingReport report =
        follow_loads<2>(make_start<2>(space), problem, options, [&](const AcceptedStep<2>& step) {
            const Field<2> u{space, step.state.displacement};
            path.emplace_back(1.0 + displacement_at<2>(u, Vector3(1.0, 0.0, 0.0))[0],
                              pressure * step.state.t);
        });
    if (!report.finished) {
        throw SolverError("{}", report.reason);
    }
    // The top of the parabola through the highest three points.
    std::size_t top = 1;
    for (std::size_t i = 1; i + 1 < path.size(); ++i) {
        top = path[i][1] > path[top][1] ? i : top;
    }
    const auto slope = [&](std::size_t i) {
        return (path[i + 1][1] - path[i][1]) / (path[i + 1][0] - path[i][0]);
    };
    const double first = 0.5 * (path[top - 1][0] + path[top][0]);
    const double second = 0.5 * (path[top][0] + path[top + 1][0]);
    const double bend = (slope(top) - slope(top - 1)) / (second - first);
    const double radius = first - slope(top - 1) / bend;
    const double slope_at_top = slope(top - 1) + bend * (path[top][0] - first);
    const double highest = path[top][1] + 0.5 * slope_at_top * (radius - path[top][0]);
    recorder.relative("largest pressure", 2.24221, highest, 2e-4);
    recorder.relative("inner radius there", 1.7536, radius, 1e-2);
    recorder.absolute("steps beyond it with falling pressure", 1.0,
                      path.back()[1] < highest && path.back()[0] > radius + 0.3 ? 1.0 : 0.0, 0.0);
}

}  // namespace

std::vector<Case> remeshing_cases() {
    return {{"neo-Hookean, meshed again: composition", false, composition},
            {"neo-Hookean, meshed again: inflated tube", false, inflated_tube},
            {"half seal, meshed again", true, half_seal},
            {"half seal, meshed again, kappa = 10", true, half_seal_kappa_10},
            {"half seal, pushed until it stops", true, half_seal_far},
            {"neo-Hookean, limit point of a sphere", false, limit_point}};
}

}  // namespace couture::verification
