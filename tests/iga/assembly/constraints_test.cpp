#include "iga/assembly/constraints.h"

#include <catch2/catch.hpp>

#include "iga/core/error.h"
#include "iga/spline/refine.h"
#include "iga/spline/shapes.h"

using namespace couture;
using namespace couture::iga;
using Catch::Matchers::Contains;

namespace {

/// Sides 0 and 1 are the arcs, 2 lies on the x axis, 3 on the y axis.
Space<2> quarter_ring() {
    MultiPatch<2> part;
    part.patches = {make_quarter_annulus(1.0, 2.0)};
    for (int side = 0; side < 4; ++side) {
        part.boundary_sets["side_" + std::to_string(side)] = {make_side<2>(0, side)};
    }
    part.boundary_sets["cuts"] = {make_side<2>(0, 2), make_side<2>(0, 3)};
    part.boundary_sets["corner"] = {entities_of_patch<2>(0, 0).front()};
    return Space<2>(part);
}

Problem plane_strain(std::vector<Support> supports) {
    Problem problem;
    problem.kinematics = Kinematics::plane_strain;
    problem.materials = {make_isotropic("steel", 200.0, 0.3)};
    problem.supports = std::move(supports);
    return problem;
}

}  // namespace

TEST_CASE("make_constraints: a set of plane sides is held along the normal of each", "[assembly]") {
    const Space<2> space = quarter_ring();
    const auto together = make_constraints(space, plane_strain({make_symmetry("cuts")}), {""});
    const auto apart = make_constraints(
        space, plane_strain({make_symmetry("side_2"), make_symmetry("side_3")}), {""});
    CHECK(together.is_fixed == apart.is_fixed);
    CHECK(std::count(together.is_fixed.begin(), together.is_fixed.end(), 1) == 2 * 2);
    CHECK(together.frames.empty());
}

TEST_CASE("make_constraints: slanted sides get frames, an edge of two planes is held along both",
          "[assembly]") {
    MultiPatch<3> part;
    part.patches = {make_box<3>(Vector3(1.0, 1.0, 1.0))};
    MatrixX points = part.patches[0].control_points();
    points.col(0) += 0.5 * points.col(1);
    part.patches[0] = Patch<3>(part.patches[0].space(), points);
    part.boundary_sets["faces"] = {make_side<3>(0, 0), make_side<3>(0, 2)};
    const Space<3> space(part);
    Problem problem;
    problem.materials = {make_isotropic("steel", 200.0, 0.3)};
    problem.supports = {make_symmetry("faces")};
    const auto constraints = make_constraints(space, problem, {""});
    for (const int dof : functions_on<3>(space.tensor(0), make_side<3>(0, 0).position)) {
        const bool is_on_edge = points(dof, 1) == 0.0;
        REQUIRE(constraints.frames.count(dof) == 1);
        CHECK(constraints.is_fixed[3 * dof] == 1);
        CHECK(constraints.is_fixed[3 * dof + 1] == (is_on_edge ? 1 : 0));
        CHECK(constraints.is_fixed[3 * dof + 2] == 0);
        const Vector3 normal(-1.0, 0.5, 0.0);
        CHECK((constraints.frames.at(dof).row(0).transpose() - normal.normalized()).norm() < 1e-14);
    }
}

TEST_CASE("make_constraints: what can't be held is named", "[assembly]") {
    const Space<2> space = quarter_ring();
    CHECK_THROWS_WITH(
        make_constraints(space, plane_strain({make_symmetry("side_1")}), {""}),
        Contains("normal displacement on 'side_1': patch 0 side 0:high is curved, its normal is") &&
            Contains("a normal can be held on planes only"));
    CHECK_THROWS_WITH(make_constraints(space, plane_strain({make_symmetry("corner")}), {""}),
                      Contains("is not a side and has no normal; hold its components instead"));
    CHECK_THROWS_WITH(
        make_constraints(
            space,
            plane_strain({make_support("side_2", 0.0, 1.0), make_support("side_0", 0.0, 2.0)}),
            {""}),
        Contains("displacement on 'side_0' contradicts the one on 'side_2' at (1, 0") &&
            Contains("leave one of them out where they meet"));
    CHECK_THROWS_AS(make_constraints(space, plane_strain({make_symmetry("none")}), {""}),
                    TopologyError);
}

TEST_CASE("make_constraints: one field prescribed on sides that meet is no contradiction",
          "[assembly]") {
    MultiPatch<3> part;
    part.patches = {make_box<3>(Vector3(1.0, 1.0, 1.0))};
    for (int side = 0; side < 6; ++side) {
        part.boundary_sets["side_" + std::to_string(side)] = {make_side<3>(0, side)};
        part.boundary_sets["outer"].push_back(make_side<3>(0, side));
    }
    const Space<3> space(refine<3>(part, 2, std::array<int, 3>{3, 2, 2}));
    const auto field = [](const std::string& on) {
        Support support = make_support(on, 0.0, 0.0, 0.0);
        support.components[0] = [](const Vector3& x, double) { return 1e-3 * x[0]; };
        support.components[1] = [](const Vector3& x, double) {
            return 1e-3 * std::sin(2.0 * x[0]) * x[2];
        };
        return support;
    };
    Problem apart;
    for (int side = 0; side < 6; ++side) {
        apart.supports.push_back(field("side_" + std::to_string(side)));
    }
    Problem together;
    together.supports = {field("outer")};
    const auto a = make_constraints(space, apart, {""});
    const auto b = make_constraints(space, together, {""});
    CHECK(a.is_fixed == b.is_fixed);
    CHECK((a.values - b.values).cwiseAbs().maxCoeff() < 1e-16);
    // Linear functions are met exactly, also by supports that hold zero beside them.
    const MatrixX positions = dof_positions(space);
    for (int dof = 0; dof < space.n_dofs(); ++dof) {
        if (a.is_fixed[3 * dof] != 0) {
            CHECK(std::abs(a.values(3 * dof, 0) - 1e-3 * positions(dof, 0)) < 1e-17);
        }
    }
    Problem beside;
    beside.supports = {make_support("side_0", 0.0, {}, {}), field("side_2")};
    CHECK_NOTHROW(make_constraints(space, beside, {""}));
}
