#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "iga/solve/linear_static.h"
#include "iga/topology/locator.h"
#include "io/spline_file.h"
#include "tests/data_folder.h"

using namespace couture;
using namespace couture::iga;

namespace {

/// Rounding of the reactions: 1e-16 of stiffness times displacement, over the forces.
constexpr double balance_error = 1e-9;
/// The same in a body 80 times longer than the part that holds it is thick.
constexpr double slender_balance_error = 1e-8;

MultiPatch<3> read_volume(const std::filesystem::path& folder, const std::string& name) {
    return std::get<MultiPatch<3>>(io::read_splines(folder / "volumes" / name).multipatch);
}

Problem elastic() {
    Problem problem;
    problem.materials = {make_isotropic("solid", 1000.0, 0.3)};
    return problem;
}

/// Largest difference over the largest value of all.
double spread(const std::vector<VectorX>& values) {
    double largest = 0.0;
    double difference = 0.0;
    for (const VectorX& value : values) {
        largest = std::max(largest, value.norm());
        difference = std::max(difference, (value - values[0]).norm());
    }
    return difference / largest;
}

struct HeldVolume {
    const char* file;
    /// Outer sides to hold: side `side` of these patches.
    std::vector<int> patches;
    int side;
    double balance = balance_error;
};

}  // namespace

TEST_CASE("solve_linear_static: eight orientations of two cubes bend alike", "[io]") {
    const auto folder = test::data_folder();
    if (!folder) {
        return;
    }
    // The functions span the same space in all files; what is left is the rounding of the systems,
    // whose condition is about 1000.
    constexpr double equal = 1e-12;
    std::vector<VectorX> volumes;
    std::vector<VectorX> energies;
    std::vector<VectorX> displacements;
    for (const char letter : std::string("abcdefgh")) {
        INFO(letter);
        const auto space = std::make_shared<const Space<3>>(
            read_volume(*folder, std::string("geopdes_geo_2cubes") + letter + ".txt"));
        Problem problem = elastic();
        problem.supports = {make_support("x_0", 0.0, 0.0, 0.0)};
        Resultant load;
        load.on = "x_1";
        load.force = Vector3(1.0, 2.0, -3.0);
        load.moment = Vector3(0.5, 0.0, 0.25);
        problem.resultants = {load};
        const LinearStaticResult<3> result = solve_linear_static(space, problem);
        const CaseResult<3>& one = result.cases.at(0);
        CHECK(one.balance < balance_error);
        CHECK((one.applied_force - load.force).norm() < equal * load.force.norm());
        volumes.emplace_back(Vector<1>(volume(space->geometry())));
        energies.emplace_back(Vector<1>(one.energy));
        const Locator<3> locator(space->geometry());
        VectorX far_corners(12);
        for (int corner = 0; corner < 4; ++corner) {
            const Vector3 point(1.0, corner % 2, corner / 2);
            const auto location = locator.find(point, 1e-10);
            REQUIRE(location);
            far_corners.segment<3>(3 * corner) =
                one.displacement.value(location->patch, location->xi);
        }
        displacements.push_back(far_corners);
    }
    CHECK(spread(volumes) < equal);
    CHECK(spread(energies) < equal);
    CHECK(spread(displacements) < equal);
    // Not by being zero.
    CHECK(displacements[0].norm() > 0.01);
    CHECK(energies[0][0] > 0.01);
}

TEST_CASE("solve_linear_static: public volumes hold under their own weight", "[io]") {
    const auto folder = test::data_folder();
    if (!folder) {
        return;
    }
    const HeldVolume held = GENERATE(values<HeldVolume>({
        {"gismo_fichera.xml", {0}, 0},
        {"gismo_twisted_fichera.xml", {0}, 0},
        {"gismo_cylinder.xml", {0}, 4},
        {"gismo_GshapedVolume.xml", {0}, 0},
        // The whole tendon.
        {"gsElasticity_bicepsLeftMP.xml", {0, 1, 2, 3, 4}, 0, slender_balance_error},
        {"mfem_pipe-nurbs.mesh", {0}, 4},
        {"mfem_ball-nurbs.mesh", {1}, 4},
        {"mfem_two-cubes-nurbs-rot.mesh", {0}, 0},
        {"geopdes_geo_sphere.txt", {1}, 1},
        {"yeti_volumetricBeam.inp", {0}, 0},
        {"yeti_elephantTrunk.inp", {0}, 4},
    }));
    INFO(held.file);
    MultiPatch<3> part = read_volume(*folder, held.file);
    const std::vector<PatchEntity<3>> outer = part.outer_sides();
    for (const int patch : held.patches) {
        const PatchEntity<3> side = make_side<3>(patch, held.side);
        REQUIRE(std::find(outer.begin(), outer.end(), side) != outer.end());
        part.boundary_sets["held"].push_back(side);
    }
    const double weight = volume(part);
    const auto space = std::make_shared<const Space<3>>(part);
    BodyForce force;
    force.components = {constant(0.3), constant(-0.2), constant(-1.0)};
    SECTION("elasticity") {
        Problem problem = elastic();
        problem.supports = {make_support("held", 0.0, 0.0, 0.0)};
        problem.body_forces = {force};
        const LinearStaticResult<3> result = solve_linear_static(space, problem);
        const CaseResult<3>& one = result.cases.at(0);
        CHECK(one.balance < held.balance);
        // Rational volumes are integrated to the accuracy of the rule.
        CHECK((one.applied_force - weight * Vector3(0.3, -0.2, -1.0)).norm() < 0.01 * weight);
        CHECK(one.energy > 0.0);
        CHECK(one.displacement.coefficients.allFinite());
        CHECK((result.solver.residual < 1e-10 || !result.solver.note.empty()));
    }
    SECTION("Poisson") {
        Problem problem;
        problem.physics = Physics::poisson;
        problem.materials.resize(1);
        problem.supports = {make_support("held", 0.0, {}, {})};
        problem.body_forces = {force};
        const LinearStaticResult<3> result = solve_linear_static(space, problem);
        const CaseResult<3>& one = result.cases.at(0);
        CHECK(one.balance < held.balance);
        CHECK(one.reactions.at("held")[0] == Approx(-one.applied_force[0]).epsilon(1e-8));
        CHECK(one.energy > 0.0);
    }
}
