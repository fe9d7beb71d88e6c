#include "iga/solve/state_transfer.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <random>

#include "iga/core/error.h"
#include "iga/core/log.h"
#include "iga/solve/load_stepping.h"
#include "iga/spline/refine.h"
#include "iga/spline/shapes.h"
#include "tests/iga/solve/rubber_problems.h"

using namespace couture;
using namespace couture::iga;
using Catch::Matchers::Contains;
using couture::iga::tests::stretched_block;

namespace {

template <int d>
MultiPatch<d> with_sides(Patch<d> patch, int degree, const std::array<int, d>& n_elements) {
    MultiPatch<d> part;
    part.patches = {std::move(patch)};
    for (int side = 0; side < 2 * d; ++side) {
        part.boundary_sets["side_" + std::to_string(side)] = {make_side<d>(0, side)};
    }
    return refine<d>(part, degree, n_elements);
}

/// The same body with inner control points moved.
template <int d>
MultiPatch<d> stirred(const MultiPatch<d>& mesh, double size) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> entry(-size, size);
    MultiPatch<d> result = mesh;
    const Patch<d>& patch = mesh.patches[0];
    MatrixX points = patch.control_points();
    for (int i = 0; i < points.rows(); ++i) {
        const std::array<int, d> at = patch.space().indices(i);
        bool is_inner = true;
        for (int k = 0; k < d; ++k) {
            is_inner = is_inner && at[k] > 0 && at[k] + 1 < patch.space().sizes()[k];
        }
        for (int k = 0; k < d && is_inner; ++k) {
            points(i, k) += entry(random);
        }
    }
    result.patches[0] = Patch<d>(patch.space(), points, patch.weights());
    return result;
}

/// A displacement given at the control points: exact where it is affine.
template <int d>
MatrixX at_control_points(const Space<d>& space,
                          const std::function<VectorX(const VectorX&)>& displacement) {
    MatrixX u(space.n_dofs(), d);
    const MatrixX& points = space.geometry().patches[0].control_points();
    for (int i = 0; i < points.rows(); ++i) {
        u.row(space.dofs(0)[i]) = displacement(points.row(i).transpose()).transpose();
    }
    return u;
}

Matrix<3> cauchy(const Problem& problem, const SteppingState<3>& state, const Vector3& xi) {
    const Matrix<3> H = total_displacement_gradient<3>(*state.reference, problem.kinematics,
                                                       state.displacement, 0, xi);
    return cauchy_stress(piola_stress(*problem.materials[0].hyperelastic, H), H);
}

}  // namespace

TEST_CASE("transfer_state: an affine deformation is carried over exactly", "[solve]") {
    const int degree = GENERATE(1, 2, 3);
    const auto space = std::make_shared<const Space<3>>(
        with_sides<3>(make_box<3>(Vector3(1.0, 2.0, 1.0)), degree, {3, 3, 3}));
    Matrix<3> H;
    H << 0.3, 0.1, 0.0, -0.2, 0.1, 0.2, 0.05, 0.0, -0.25;
    const MatrixX u =
        at_control_points<3>(*space, [&](const VectorX& x) -> VectorX { return H * x; });
    const auto old = make_reference<3>(space);
    const MultiPatch<3> body = deformed_body<3>(*old, u);
    const Transfer transfer = GENERATE(Transfer::displacement, Transfer::gradient);
    const TransferredState<3> moved =
        transfer_state<3>(*old, Kinematics::solid, u, stirred<3>(body, 0.04),
                          {.n_gauss_points = {}, .transfer = transfer});
    CHECK(moved.transfer == transfer);
    CHECK(moved.gradient_drift < 1e-12);
    CHECK(moved.largest_gap < 1e-12);
    CHECK(moved.min_det_F == Approx((Matrix<3>::Identity() + H).determinant()).epsilon(1e-12));
    CHECK(moved.reference->is_undeformed() == (transfer == Transfer::displacement));
    const Vector3 xi(0.21, 0.62, 0.44);
    CHECK((total_displacement_gradient<3>(*moved.reference, Kinematics::solid, moved.displacement,
                                          0, xi) -
           H)
              .norm() < 1e-12);
    // The undeformed body in the new patches, and the place that they came from.
    const SpacePtr<3> undeformed = moved.reference->undeformed();
    CHECK(volume(undeformed->geometry()) == Approx(2.0).epsilon(1e-12));
    const VectorX X = undeformed->geometry().patches[0].point(xi);
    const Field<3> U{undeformed, moved.displacement};
    CHECK((U.value(0, xi) - H * X).norm() < 1e-12);
    const MultiPatch<3> again = deformed_body<3>(*moved.reference, moved.displacement);
    CHECK((again.patches[0].control_points() - stirred<3>(body, 0.04).patches[0].control_points())
              .norm() < 1e-12);
}

TEST_CASE("transfer_state: rational patches keep affine deformations", "[solve]") {
    const auto space =
        std::make_shared<const Space<2>>(with_sides<2>(make_quarter_annulus(1.0, 2.0), 2, {4, 4}));
    Matrix<2> H;
    H << 0.3, 0.1, -0.2, 0.1;
    const MatrixX u =
        at_control_points<2>(*space, [&](const VectorX& x) -> VectorX { return H * x; });
    const auto old = make_reference<2>(space);
    const MultiPatch<2> body = deformed_body<2>(*old, u);
    const TransferredState<2> moved =
        transfer_state<2>(*old, Kinematics::plane_strain, u, stirred<2>(body, 0.02));
    CHECK(moved.gradient_drift < 1e-11);
    CHECK(volume(moved.reference->undeformed()->geometry()) ==
          Approx(0.75 * 3.14159265358979).epsilon(1e-11));
}

TEST_CASE("transfer_state: where the new mesh would fold moved back, the gradient is carried over",
          "[solve]") {
    // A square whose inside is turned: the farther in, the more.
    const auto square = [](int n) {
        return with_sides<2>(make_box<2>(Vector2(2.0, 2.0)), 1, {n, n});
    };
    const double turn = 3.0;
    const auto space = std::make_shared<const Space<2>>(square(48));
    const MatrixX u = at_control_points<2>(*space, [&](const VectorX& x) -> VectorX {
        const Vector2 from_middle = x - Vector2(1.0, 1.0);
        const double inside = std::max(0.0, 1.0 - from_middle.squaredNorm());
        return Eigen::Rotation2Dd(turn * inside * inside) * from_middle - from_middle;
    });
    const auto old = make_reference<2>(space);
    const TransferredState<2> fine =
        transfer_state<2>(*old, Kinematics::plane_strain, u, square(24));
    CHECK(fine.transfer == Transfer::displacement);
    const TransferredState<2> coarse =
        transfer_state<2>(*old, Kinematics::plane_strain, u, square(4));
    CHECK(coarse.transfer == Transfer::gradient);
    CHECK_FALSE(coarse.reference->is_undeformed());
    CHECK(coarse.min_det_F > 0.0);
    CHECK(coarse.gradient_drift > fine.gradient_drift);
}

TEST_CASE("transfer_state: a point outside the old mesh is named", "[solve]") {
    const auto space = std::make_shared<const Space<3>>(
        with_sides<3>(make_box<3>(Vector3(1.0, 1.0, 1.0)), 1, {2, 2, 2}));
    const MatrixX u = MatrixX::Zero(space->n_dofs(), 3);
    MultiPatch<3> larger = space->geometry();
    larger.patches[0] =
        Patch<3>(larger.patches[0].space(), 1.2 * larger.patches[0].control_points());
    CHECK_THROWS_WITH(transfer_state<3>(*make_reference<3>(space), Kinematics::solid, u, larger),
                      Contains("of the new mesh (patch 0 at parameter (") &&
                          Contains("outside the old one, more than 0.0346"));
}

TEST_CASE("follow_loads: a homogeneous state goes on through remeshings to its closed form",
          "[solve]") {
    const auto space = std::make_shared<const Space<3>>(stirred<3>(
        with_sides<3>(make_box<3>(Vector3(1.0, 1.0, 1.0)), GENERATE(1, 2), {3, 3, 3}), 0.12));
    const Problem problem = stretched_block(2.0);
    Remeshing<3> remeshing;
    remeshing.times = {0.25, 0.5};
    remeshing.transfer = GENERATE(Transfer::displacement, Transfer::gradient);
    int n_meshes = 0;
    remeshing.mesh = [&](const MultiPatch<3>& body) {
        ++n_meshes;
        return stirred<3>(body, -0.04);
    };
    std::vector<AcceptedStep<3>> steps;
    const SteppingReport report = follow_loads<3>(
        make_start<3>(space), problem, {},
        [&](const AcceptedStep<3>& step) { steps.push_back(step); }, remeshing);
    REQUIRE(report.finished);
    CHECK(report.n_remeshings == 2);
    CHECK(n_meshes == 2);
    const SteppingState<3>& last = steps.back().state;
    CHECK(cauchy(problem, last, Vector3(0.3, 0.7, 0.4))(0, 0) ==
          Approx(8.2946926763).epsilon(1e-9));
    CHECK(steps.back().reactions.at("side_1")[0] == Approx(4.7206957265).epsilon(1e-9));
    for (const AcceptedStep<3>& step : steps) {
        if (step.remeshing) {
            CHECK(step.remeshing->cause == "time");
            CHECK(step.remeshing->energy_transferred ==
                  Approx(step.remeshing->energy_before).epsilon(1e-11));
            CHECK(step.remeshing->volume_after ==
                  Approx(step.remeshing->volume_before).epsilon(1e-11));
            CHECK(step.remeshing->gradient_drift < 1e-10);
        }
    }
}

TEST_CASE("follow_loads: a run goes on from a remeshed state as if it had not stopped", "[solve]") {
    const auto space = std::make_shared<const Space<3>>(
        stirred<3>(with_sides<3>(make_box<3>(Vector3(1.0, 1.0, 1.0)), 1, {2, 2, 2}), 0.1));
    const Problem problem = stretched_block(1.5);
    Remeshing<3> remeshing;
    remeshing.times = {0.5};
    remeshing.transfer = GENERATE(Transfer::displacement, Transfer::gradient);
    remeshing.mesh = [](const MultiPatch<3>& body) { return stirred<3>(body, -0.08); };
    std::vector<AcceptedStep<3>> steps;
    const auto keep = [&](const AcceptedStep<3>& step) { steps.push_back(step); };
    REQUIRE(follow_loads<3>(make_start<3>(space), problem, {}, keep, remeshing).finished);
    const std::vector<AcceptedStep<3>> all = steps;
    const auto at_remeshing = std::find_if(
        all.begin(), all.end(), [](const AcceptedStep<3>& step) { return step.remeshing; });
    REQUIRE(at_remeshing != all.end());
    // From the state before it, which remeshes again, and from the one after.
    for (const auto& from : {at_remeshing - 1, at_remeshing}) {
        steps.clear();
        REQUIRE(follow_loads<3>(from->state, problem, {}, keep, remeshing).finished);
        CHECK(steps.size() == static_cast<std::size_t>(all.end() - from) - 1);
        CHECK(steps.back().state.displacement == all.back().state.displacement);
        CHECK(steps.back().state.work == all.back().state.work);
    }
}

TEST_CASE("follow_loads: a new mesh that can't be used is left, the run goes on", "[solve]") {
    const auto space = std::make_shared<const Space<3>>(
        with_sides<3>(make_box<3>(Vector3(1.0, 1.0, 1.0)), 1, {2, 2, 2}));
    Remeshing<3> remeshing;
    remeshing.times = {0.5};
    std::string why;
    SECTION("another body") {
        remeshing.mesh = [](const MultiPatch<3>& body) {
            MultiPatch<3> other = body;
            other.boundary_sets.clear();
            return other;
        };
        why = "the new mesh has signature";
    }
    SECTION("worse elements") {
        remeshing.mesh = [](const MultiPatch<3>& body) { return stirred<3>(body, 0.1); };
        why = "the new mesh is no better: worst shape ratio";
    }
    SECTION("no mesh") {
        remeshing.mesh = [](const MultiPatch<3>&) -> MultiPatch<3> {
            throw GeometryError("nothing fits");
        };
        why = "failed: nothing fits";
    }
    const auto run = [&](const Remeshing<3>& how) {
        MatrixX last;
        const SteppingReport report = follow_loads<3>(
            make_start<3>(space), stretched_block(1.5), {},
            [&](const AcceptedStep<3>& step) { last = step.state.displacement; }, how);
        CHECK(report.finished);
        CHECK(report.n_remeshings == 0);
        return last;
    };
    log::clear_warnings();
    const MatrixX tried = run(remeshing);
    const std::vector<std::string> warnings = log::warnings();
    REQUIRE(warnings.size() == 1);
    CHECK_THAT(warnings[0], Contains("remeshing at t = 0.5 (time) failed: ") && Contains(why) &&
                                Contains("the run goes on with the old mesh"));
    Remeshing<3> none;
    none.times = remeshing.times;
    CHECK(tried == run(none));
}

TEST_CASE("follow_loads: elements that get worse than a limit are meshed again", "[solve]") {
    const auto space = std::make_shared<const Space<3>>(
        stirred<3>(with_sides<3>(make_box<3>(Vector3(1.0, 1.0, 1.0)), 1, {2, 2, 2}), 0.1));
    Remeshing<3> remeshing;
    remeshing.mesh = [](const MultiPatch<3>& body) { return stirred<3>(body, -0.05); };
    std::string cause;
    SECTION("shape ratio") {
        remeshing.shape_ratio = 2.1;
        cause = "shape ratio ";
    }
    SECTION("scaled Jacobian") {
        remeshing.scaled_jacobian = 0.99;
        cause = "scaled Jacobian ";
    }
    SECTION("angle deviation") {
        remeshing.angle_deviation = 0.5;
        cause = "angle deviation ";
    }
    std::vector<RemeshingReport> reports;
    const SteppingReport report = follow_loads<3>(
        make_start<3>(space), stretched_block(1.5), {},
        [&](const AcceptedStep<3>& step) {
            if (step.remeshing) {
                reports.push_back(*step.remeshing);
            }
        },
        remeshing);
    CHECK(report.finished);
    REQUIRE_FALSE(reports.empty());
    CHECK_THAT(reports[0].cause, Contains(cause));
    log::clear_warnings();
}

TEST_CASE("follow_loads: a remeshing on failure that fails ends the run and says both", "[solve]") {
    // The moving face would pass through the held one.
    const auto space = std::make_shared<const Space<3>>(
        with_sides<3>(make_box<3>(Vector3(1.0, 1.0, 1.0)), 1, {1, 1, 1}));
    Remeshing<3> remeshing;
    remeshing.on_failure = true;
    remeshing.mesh = [](const MultiPatch<3>&) -> MultiPatch<3> {
        throw GeometryError("nothing fits");
    };
    SteppingOptions options;
    options.smallest_step = 1e-2;
    double last = 0.0;
    const SteppingReport report = follow_loads<3>(
        make_start<3>(space), stretched_block(-0.5), options,
        [&](const AcceptedStep<3>& step) { last = step.state.t; }, remeshing);
    CHECK_FALSE(report.finished);
    CHECK(report.t == last);
    CHECK_THAT(report.reason, Contains("no equilibrium beyond t = ") &&
                                  Contains("(Newton failed) failed: nothing fits"));
    log::clear_warnings();
}

TEST_CASE("follow_loads: the number of remeshings is kept to", "[solve]") {
    const auto space = std::make_shared<const Space<3>>(
        stirred<3>(with_sides<3>(make_box<3>(Vector3(1.0, 1.0, 1.0)), 1, {2, 2, 2}), 0.1));
    Remeshing<3> remeshing;
    remeshing.times = {0.3, 0.6};
    remeshing.max_remeshings = 1;
    remeshing.mesh = [](const MultiPatch<3>& body) { return stirred<3>(body, -0.05); };
    log::clear_warnings();
    const SteppingReport report = follow_loads<3>(
        make_start<3>(space), stretched_block(1.5), {}, [](const AcceptedStep<3>&) {}, remeshing);
    CHECK(report.finished);
    CHECK(report.n_remeshings == 1);
    REQUIRE(log::warnings().size() == 1);
    CHECK(log::warnings()[0] == "a remeshing is due (time), but max_remeshings = 1 are done");
}
