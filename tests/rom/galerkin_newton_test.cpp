#include "rom/galerkin_newton.h"

#include <catch2/catch.hpp>

#include "iga/core/error.h"
#include "tests/rom/box_family.h"

using namespace couture;
using namespace couture::rom;
using Catch::Contains;
using couture::tests::BoxFamily;

namespace {

const ReducedModel& model() {
    static const ReducedModel trained(BoxFamily::snapshots(),
                                      {.kriging = {.trend = Trend::linear}});
    return trained;
}

VectorX somewhere(double force) {
    VectorX point = BoxFamily::point({0.3, 0.7, 0.0, 0.2, 0.1, 0.6});
    point[BoxFamily::force] = force;
    return point;
}

/// The solid that has the same stiffness at small strains.
iga::Problem rubber(const VectorX& point) {
    iga::Problem problem = BoxFamily::problem(point);
    const double E = point[BoxFamily::youngs_modulus];
    const double nu = point[BoxFamily::poissons_ratio];
    problem.materials[0].hyperelastic = iga::make_hyperelastic(
        iga::StoredEnergy::neo_hookean, E / (2.0 * (1.0 + nu)), E / (3.0 * (1.0 - 2.0 * nu)));
    return problem;
}

GalerkinSolution step(const VectorX& point) {
    return galerkin_newton_step(model(), model().evaluate(point), rubber(point));
}

}  // namespace

TEST_CASE("galerkin_newton_step: at small strains it is the linear solution", "[rom]") {
    const VectorX point = somewhere(1.0);
    const GalerkinSolution linear =
        solve_galerkin(model(), model().evaluate(point), BoxFamily::problem(point));
    const GalerkinSolution newton = step(point);
    CHECK((newton.displacement - linear.displacement).norm() < 1e-4 * linear.displacement.norm());
    CHECK(newton.energy == Approx(linear.energy).epsilon(1e-3));
    CHECK(newton.relative_change == Approx(linear.relative_change).epsilon(0.01));
}

TEST_CASE("galerkin_newton_step: lowers the residual at finite strain", "[rom]") {
    // The tip moves by a tenth of the length.
    VectorX point = somewhere(100.0);
    point[BoxFamily::force] *= 2.0 / model().evaluate(point).displacement.cwiseAbs().maxCoeff();
    const GalerkinSolution newton = step(point);
    CHECK(newton.relative_residual < newton.relative_residual_of_kriging);
    CHECK(newton.relative_change > 0.0);
    CHECK(newton.n_modes <= model().displacement_modes().cols());
}

TEST_CASE("galerkin_newton_step: refuses bodies that are folded", "[rom]") {
    VectorX point = somewhere(100.0);
    point[BoxFamily::force] *= 1e3 / model().evaluate(point).displacement.cwiseAbs().maxCoeff();
    CHECK_THROWS_WITH(step(point), Contains("the body is folded as predicted"));
    CHECK_THROWS_AS(galerkin_newton_step(model(), model().evaluate(somewhere(1.0)),
                                         BoxFamily::problem(somewhere(1.0))),
                    InputError);
}
