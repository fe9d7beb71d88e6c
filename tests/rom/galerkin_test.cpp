#include "rom/galerkin.h"

#include <catch2/catch.hpp>

#include "iga/core/error.h"
#include "tests/rom/box_family.h"

using namespace couture;
using namespace couture::rom;
using Catch::Contains;
using couture::tests::BoxFamily;

namespace {

const ReducedModelOptions linear_trend{.kriging = {.trend = Trend::linear}};

const SnapshotSet& family() {
    static const SnapshotSet set = BoxFamily::snapshots();
    return set;
}

VectorX somewhere() { return BoxFamily::point({0.3, 0.7, 0.9, 0.2, 0.1, 0.6}); }

GalerkinSolution solve(const ReducedModel& model, const VectorX& point) {
    return solve_galerkin(model, model.evaluate(point), BoxFamily::problem(point));
}

double relative_error(const VectorX& value, const VectorX& expected) {
    return (value - expected).norm() / expected.norm();
}

}  // namespace

TEST_CASE("solve_galerkin: all modes give back the full solution at a snapshot", "[rom]") {
    const ReducedModel model(family(), linear_trend);
    const VectorX corner = BoxFamily::point({0.0, 1.0, 0.4, 0.5, 0.3, 1.0});
    const GalerkinSolution there = solve(model, corner);
    CHECK(relative_error(there.displacement, BoxFamily::solve(corner)) < 1e-8);
    CHECK(there.relative_residual < 1e-6);
}

TEST_CASE("solve_galerkin: better than kriging between the snapshots, and says how good", "[rom]") {
    ReducedModelOptions options = linear_trend;
    options.basis = GENERATE(BasisKind::separate, BasisKind::stacked);
    options.n_modes = 12;
    const ReducedModel model(family(), options);
    const VectorX full = BoxFamily::solve(somewhere());
    const double kriging = relative_error(model.evaluate(somewhere()).displacement, full);
    const GalerkinSolution there = solve(model, somewhere());
    CHECK(relative_error(there.displacement, full) < kriging);
    CHECK(there.relative_residual > 0.0);
    CHECK(there.relative_residual < there.relative_residual_of_kriging);
    CHECK(there.relative_change > 0.0);
    if (options.basis == BasisKind::separate) {
        // The geometry is exact: less energy is stored in a space of fewer functions.
        const auto result = iga::solve_linear_static<3>(
            std::make_shared<const iga::Space<3>>(BoxFamily::geometry(somewhere())),
            BoxFamily::problem(somewhere()));
        CHECK(there.energy < result.cases[0].energy * (1.0 + 1e-9));
        CHECK(there.energy > 0.99 * result.cases[0].energy);
    }
}

TEST_CASE("solve_galerkin: more modes, more of the energy", "[rom]") {
    double before = 0.0;
    for (const int n_modes : {1, 4, 12, 40}) {
        ReducedModelOptions options = linear_trend;
        options.n_modes = n_modes;
        const GalerkinSolution there = solve(ReducedModel(family(), options), somewhere());
        CHECK(there.n_modes == n_modes);
        CHECK(there.energy > before);
        before = there.energy;
    }
}

TEST_CASE("projected_displacements: the full solution where the fields hold it, else near",
          "[rom]") {
    const VectorX there = somewhere();
    const iga::Space<3> member(BoxFamily::geometry(there));
    iga::Problem problem = BoxFamily::problem(there);
    problem.resultants[0].load_case = "pull";
    problem.resultants.push_back(problem.resultants[0]);
    problem.resultants[1].load_case = "twice";
    problem.resultants[1].force *= 2.0;
    const VectorX full = BoxFamily::solve(there);
    MatrixX fields = ReducedModel(family(), linear_trend).displacement_modes().leftCols(12);
    const MatrixX near = projected_displacements(member, fields, problem);
    REQUIRE(near.cols() == 2);
    CHECK(relative_error(near.col(0), full) > 1e-6);
    CHECK(relative_error(near.col(0), full) < 0.02);
    CHECK(relative_error(near.col(1), 2.0 * near.col(0)) < 1e-12);
    fields.col(3) = full;
    CHECK(relative_error(projected_displacements(member, fields, problem).col(0), full) < 1e-8);
    CHECK_THROWS_WITH(projected_displacements(member, fields.topRows(9), problem),
                      Contains("fields of 9 values"));
}

TEST_CASE("solve_galerkin: prescribed displacements are held", "[rom]") {
    const ReducedModel model(family(), linear_trend);
    iga::Problem problem = BoxFamily::problem(somewhere());
    problem.supports.push_back(iga::make_support("tip", 0.01, {}, {}));
    const GalerkinSolution there = solve_galerkin(model, model.evaluate(somewhere()), problem);
    for (const int node : model.space()->dofs_on(iga::make_side<3>(1, 1))) {
        CHECK(there.displacement[3 * node] == Approx(0.01).epsilon(1e-12));
    }
}

TEST_CASE("solve_galerkin: refuses what it can't project", "[rom]") {
    ReducedModelOptions options = linear_trend;
    options.n_modes = 2;
    const ReducedModel model(family(), options);
    const Evaluation there = model.evaluate(somewhere());
    iga::Problem problem = BoxFamily::problem(somewhere());
    CHECK_THROWS_WITH(solve_galerkin(model, there, problem, "gale"),
                      Contains("no load case 'gale'"));
    problem.materials[0].hyperelastic =
        iga::make_hyperelastic(iga::StoredEnergy::neo_hookean, 1.0, 2.0);
    CHECK_THROWS_WITH(solve_galerkin(model, there, problem), Contains("'steel' is hyperelastic"));
    problem = BoxFamily::problem(somewhere());
    problem.supports.clear();
    CHECK_THROWS_AS(solve_galerkin(model, there, problem), InputError);
}
