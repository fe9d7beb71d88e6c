#include "iga/solve/load_stepping.h"

#include <algorithm>
#include <catch2/catch.hpp>

#include "iga/core/error.h"
#include "iga/spline/refine.h"
#include "iga/spline/shapes.h"
#include "tests/iga/solve/rubber_problems.h"

using namespace couture;
using namespace couture::iga;
using Catch::Matchers::Contains;
using couture::iga::tests::rubber;
using couture::iga::tests::stretched_block;

namespace {

template <int d>
SpacePtr<d> space_of(Patch<d> patch, int degree, const std::array<int, d>& n_elements) {
    MultiPatch<d> part;
    part.patches = {std::move(patch)};
    for (int side = 0; side < 2 * d; ++side) {
        part.boundary_sets["side_" + std::to_string(side)] = {make_side<d>(0, side)};
    }
    return std::make_shared<const Space<d>>(refine<d>(part, degree, n_elements));
}

template <int d>
std::vector<AcceptedStep<d>> run(const SpacePtr<d>& space, const Problem& problem,
                                 const SteppingOptions& options, SteppingReport& report) {
    std::vector<AcceptedStep<d>> steps;
    report = follow_loads<d>(make_start<d>(space), problem, options,
                             [&](const AcceptedStep<d>& step) { steps.push_back(step); });
    return steps;
}

}  // namespace

TEST_CASE("follow_loads: uniaxial tension has its closed form", "[solve]") {
    const SpacePtr<3> space = space_of<3>(make_box<3>(Vector3(1.0, 1.0, 1.0)), 2, {2, 2, 1});
    SteppingReport report;
    const auto steps = run<3>(space, stretched_block(2.0), {}, report);
    REQUIRE(report.finished);
    const AcceptedStep<3>& last = steps.back();
    CHECK(last.state.t == 1.0);
    const Field<3> u{space, last.state.displacement};
    CHECK(u.value(0, Vector3(0.3, 1.0, 0.5))[1] == Approx(0.7544020407 - 1.0).epsilon(1e-8));
    CHECK(last.reactions.at("side_1")[0] == Approx(4.7206957265).epsilon(1e-8));
    CHECK(last.reactions.at("side_0")[0] == Approx(-4.7206957265).epsilon(1e-8));
}

TEST_CASE("follow_loads: Newton converges quadratically", "[solve]") {
    const SpacePtr<2> space = space_of<2>(make_quarter_annulus(1.0, 2.0), 2, {3, 3});
    Problem problem = rubber(Kinematics::plane_strain);
    problem.supports = {make_symmetry("side_2"), make_symmetry("side_3")};
    problem.pressures = {make_pressure("side_0", 0.5)};
    SteppingOptions options;
    options.first_step = options.largest_step = 1.0;
    options.newton.tolerance = 1e-12;
    SteppingReport report;
    const auto steps = run<2>(space, problem, options, report);
    REQUIRE(report.finished);
    const std::vector<double>& r = steps.at(0).newton.residuals;
    REQUIRE(r.size() >= 4);
    // |r| falls at least as its square times a constant of order one, from where it is small.
    for (std::size_t i = 1; i + 1 < r.size(); ++i) {
        if (r[i] < 0.1 && r[i + 1] > 1e-13) {
            CHECK(r[i + 1] < 10.0 * r[i] * r[i]);
        }
    }
    CHECK(steps.at(0).newton.iterations <= 7);
}

TEST_CASE("follow_loads: a tube inflated by follower pressure", "[solve]") {
    const SpacePtr<2> space = space_of<2>(make_quarter_annulus(1.0, 2.0), 4, {6, 2});
    Problem problem = rubber(Kinematics::plane_strain);
    problem.supports = {make_symmetry("side_2"), make_symmetry("side_3")};
    problem.pressures = {make_pressure("side_0", 0.7906356787)};
    SteppingReport report;
    const auto steps = run<2>(space, problem, {}, report);
    REQUIRE(report.finished);
    const Field<2> u{space, steps.back().state.displacement};
    CHECK(u.value(0, Vector2(0.0, 0.0)).norm() == Approx(0.25).epsilon(1e-5));
    CHECK(u.value(0, Vector2(1.0, 1.0)).norm() == Approx(0.1486155550).epsilon(1e-5));
}

TEST_CASE("follow_loads: without a matrix the same path", "[solve]") {
    // Held at both ends, so that the stretch is not uniform.
    const SpacePtr<3> space = space_of<3>(make_box<3>(Vector3(1.0, 1.0, 1.0)), 2, {3, 3, 2});
    Problem problem = rubber(Kinematics::solid);
    problem.supports = {make_support("side_0", 0.0, 0.0, 0.0),
                        make_support("side_1", 0.4, 0.1, 0.0)};
    SteppingOptions options;
    SteppingReport report;
    const auto with_matrix = run<3>(space, problem, options, report);
    REQUIRE(report.finished);
    options.newton.solver.name = "matrix_free";
    const auto without = run<3>(space, problem, options, report);
    REQUIRE(report.finished);
    REQUIRE(with_matrix.size() == without.size());
    for (std::size_t i = 0; i < without.size(); ++i) {
        CHECK(without[i].newton.iterations == with_matrix[i].newton.iterations);
    }
    const MatrixX& u = with_matrix.back().state.displacement;
    CHECK((without.back().state.displacement - u).norm() < 1e-6 * u.norm());

    options.volumetric = Volumetric::projected;
    CHECK_THROWS_WITH(run<3>(space, problem, options, report),
                      Contains("set volumetric = \"full\""));
}

TEST_CASE("follow_loads: a path without equilibrium is cut down and given up", "[solve]") {
    // The moving face would pass through the held one.
    const SpacePtr<3> space = space_of<3>(make_box<3>(Vector3(1.0, 1.0, 1.0)), 1, {1, 1, 1});
    Problem problem = stretched_block(-0.5);
    SteppingOptions options;
    options.smallest_step = 1e-3;
    SteppingReport report;
    const auto steps = run<3>(space, problem, options, report);
    CHECK_FALSE(report.finished);
    CHECK(report.n_cuts > 0);
    REQUIRE_FALSE(steps.empty());
    CHECK(report.t == steps.back().state.t);
    // The face reaches the other side at t = 2/3.
    CHECK(report.t < 2.0 / 3.0);
    CHECK(report.t > 0.5);
    CHECK_THAT(report.reason, Contains("no equilibrium beyond t = "));
}

TEST_CASE("follow_loads: a run goes on from a state as if it had not stopped", "[solve]") {
    const SpacePtr<3> space = space_of<3>(make_box<3>(Vector3(1.0, 1.0, 1.0)), 2, {1, 1, 1});
    SteppingReport report;
    const auto all = run<3>(space, stretched_block(1.6), {}, report);
    REQUIRE(all.size() > 3);
    std::vector<double> times;
    MatrixX last;
    const auto rest =
        follow_loads<3>(all[1].state, stretched_block(1.6), {}, [&](const AcceptedStep<3>& step) {
            times.push_back(step.state.t);
            last = step.state.displacement;
        });
    CHECK(rest.finished);
    CHECK(times.size() == all.size() - 2);
    CHECK(last == all.back().state.displacement);
}

TEST_CASE("follow_loads: arc length passes the limit point of an inflated sphere", "[solve]") {
    MultiPatch<2> part;
    part.patches = {make_quarter_annulus(1.0, 2.0)};
    for (int side = 0; side < 4; ++side) {
        part.boundary_sets["side_" + std::to_string(side)] = {make_side<2>(0, side)};
    }
    const auto space =
        std::make_shared<const Space<2>>(refine<2>(part, 3, std::array<int, 2>{4, 2}));
    Problem problem = rubber(Kinematics::axisymmetric);
    problem.supports = {make_support("side_2", {}, 0.0), make_support("side_3", 0.0, {})};
    // A third more than the sphere bears.
    problem.pressures = {make_pressure("side_0", 3.0)};
    SteppingOptions options;
    options.control = Control::arc_length;
    options.max_steps = 30;
    SteppingReport report;
    const auto steps = run<2>(space, problem, options, report);
    CHECK(report.finished);
    REQUIRE(steps.size() == 30);
    double largest = 0.0;
    double radius_there = 0.0;
    double radius = 1.0;
    for (const AcceptedStep<2>& step : steps) {
        const double before = radius;
        radius = 1.0 + Field<2>{space, step.state.displacement}.value(0, Vector2(0.0, 0.0)).norm();
        CHECK(radius > before);
        CHECK(step.newton.iterations <= 8);
        if (3.0 * step.state.t > largest) {
            largest = 3.0 * step.state.t;
            radius_there = radius;
        }
    }
    // Between two steps: the pressure is flat there, the radius is not.
    CHECK(largest == Approx(2.24221).epsilon(2e-3));
    CHECK(radius_there == Approx(1.7536).epsilon(0.05));
    CHECK(radius > 2.0);
    CHECK(3.0 * steps.back().state.t < 0.98 * largest);
}

TEST_CASE("follow_loads: arc length ends at the end of time", "[solve]") {
    const SpacePtr<3> space = space_of<3>(make_box<3>(Vector3(1.0, 1.0, 1.0)), 1, {1, 1, 1});
    SteppingOptions options;
    options.control = Control::arc_length;
    options.max_steps = 50;
    SteppingReport report;
    const auto steps = run<3>(space, stretched_block(1.5), options, report);
    REQUIRE(report.finished);
    CHECK(report.reason.empty());
    CHECK(steps.back().state.t == 1.0);
    CHECK(steps.back().reactions.at("side_1")[0] == Approx(2.9415058076).epsilon(1e-8));
}

TEST_CASE("follow_loads: a follower pressure without a potential converges quadratically",
          "[solve]") {
    // A cantilever whose free upper side is pressed: its rim is held at one end only.
    const SpacePtr<2> space = space_of<2>(make_box<2>(Vector2(4.0, 1.0)), 2, {4, 2});
    Problem problem = rubber(Kinematics::plane_strain);
    problem.supports = {make_support("side_0", 0.0, 0.0)};
    problem.pressures = {make_pressure("side_3", 0.06)};
    SteppingOptions options;
    options.first_step = options.largest_step = 0.25;
    options.newton.tolerance = 1e-12;
    SteppingReport report;
    const auto steps = run<2>(space, problem, options, report);
    REQUIRE(report.finished);
    const Field<2> u{space, steps.back().state.displacement};
    CHECK(u.value(0, Vector2(1.0, 0.5))[1] < -0.8);
    for (const AcceptedStep<2>& step : steps) {
        const std::vector<double>& r = step.newton.residuals;
        CHECK(r.size() <= 9);
        for (std::size_t i = 1; i + 1 < r.size(); ++i) {
            // Bending keeps the residual up before.
            if (r[i] < 1e-4) {
                CHECK(r[i + 1] < 200.0 * r[i] * r[i] + 1e-13);
            }
        }
    }
}

TEST_CASE("follow_loads: steps end at the stops, work is energy", "[solve]") {
    const SpacePtr<3> space = space_of<3>(make_box<3>(Vector3(1.0, 1.0, 1.0)), 2, {1, 1, 1});
    SteppingOptions options;
    options.first_step = options.largest_step = 0.02;
    options.stops = {0.13, 0.51};
    SteppingReport report;
    const auto steps = run<3>(space, stretched_block(1.5), options, report);
    REQUIRE(report.finished);
    for (const double stop : options.stops) {
        CHECK(std::any_of(steps.begin(), steps.end(),
                          [&](const AcceptedStep<3>& step) { return step.state.t == stop; }));
    }
    // Trapezoids: the square of the step is missing.
    CHECK(steps.back().state.work == Approx(steps.back().energy).epsilon(1e-3));
}

TEST_CASE("follow_loads: what it can't take is named", "[solve]") {
    const SpacePtr<3> space = space_of<3>(make_box<3>(Vector3(1.0, 1.0, 1.0)), 1, {1, 1, 1});
    const auto try_it = [&](const Problem& problem, const SteppingOptions& options = {}) {
        SteppingReport report;
        run<3>(space, problem, options, report);
    };
    Problem cases = stretched_block(1.1);
    cases.supports[3].load_case = "pull";
    CHECK_THROWS_WITH(try_it(cases), Contains("load case 'pull': hyperelastic bodies are loaded"));
    Problem hot = stretched_block(1.1);
    hot.temperatures.resize(1);
    hot.temperatures[0].change = constant(1.0);
    CHECK_THROWS_WITH(try_it(hot), Contains("have no thermal strain"));
    Problem loose = stretched_block(1.1);
    loose.supports.erase(loose.supports.begin() + 1);
    CHECK_THROWS_WITH(try_it(loose), Contains("free rigid-body motions: translation along y"));
    SteppingOptions options;
    options.smallest_step = 1.0;
    CHECK_THROWS_WITH(try_it(stretched_block(1.1), options),
                      "load steps: smallest 1, first 0.1, largest 0.25; must be positive and not "
                      "decrease");
    options = {};
    options.smallest_step = 1e-17;
    CHECK_THROWS_WITH(try_it(stretched_block(1.1), options),
                      Contains("smallest 1e-17; must be at least 1e-10 of the end, 1"));
    options = {};
    options.control = Control::arc_length;
    CHECK_THROWS_WITH(try_it(stretched_block(1.1), options),
                      "load steps: an arc-length run may never reach its end; give max_steps");
}

TEST_CASE("follow_loads: forces beyond all numbers are no equilibrium", "[solve]") {
    const SpacePtr<3> space = space_of<3>(make_box<3>(Vector3(1.0, 1.0, 1.0)), 1, {1, 1, 1});
    Problem problem = stretched_block(1.0);
    problem.supports.pop_back();
    problem.pressures = {make_pressure("side_1", -1e160)};
    SteppingReport report;
    const auto steps = run<3>(space, problem, {}, report);
    CHECK(steps.empty());
    CHECK_FALSE(report.finished);
    CHECK_THAT(report.reason, Contains("not finite"));
}

TEST_CASE("follow_loads: a folded start is named", "[solve]") {
    const SpacePtr<3> space = space_of<3>(make_box<3>(Vector3(1.0, 1.0, 1.0)), 1, {1, 1, 1});
    SteppingState<3> folded = make_start<3>(space);
    folded.displacement = -1.5 * space->geometry().patches[0].control_points();
    const auto report =
        follow_loads<3>(folded, stretched_block(1.1), {}, [](const AcceptedStep<3>&) {});
    CHECK_FALSE(report.finished);
    CHECK(report.n_steps == 0);
    CHECK_THAT(report.reason, Contains("the start is folded: det F = -0.125 in patch 0 at"));
}
