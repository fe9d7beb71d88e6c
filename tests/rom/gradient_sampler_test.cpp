#include "rom/gradient_sampler.h"

#include <catch2/catch.hpp>

#include "iga/core/error.h"
#include "rom/field_sampler.h"
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

std::vector<SampleGrid> grids() {
    return make_sample_grids(*model().space(), SampleRegion::volume);
}

VectorX somewhere() { return BoxFamily::point({0.3, 0.7, 0.9, 0.2, 0.1, 0.6}); }

const std::vector<int> all = {0, 1, 2, 3, 4, 5};

iga::Problem warm(const VectorX& point) {
    iga::Problem problem = BoxFamily::problem(point);
    problem.materials[0].thermal_expansion.setConstant(1e-5);
    iga::Temperature temperature;
    // Of the place and of a parameter.
    temperature.change = [lift = point[BoxFamily::lift]](const Vector3& x, double) {
        return (2.0 + lift) * x[0];
    };
    problem.temperatures = {temperature};
    return problem;
}

iga::Problem rubber(const VectorX& point) {
    iga::Problem problem = BoxFamily::problem(point);
    const double E = point[BoxFamily::youngs_modulus];
    const double nu = point[BoxFamily::poissons_ratio];
    problem.materials[0].hyperelastic = iga::make_hyperelastic(
        iga::StoredEnergy::neo_hookean, E / (2.0 * (1.0 + nu)), E / (3.0 * (1.0 - 2.0 * nu)));
    return problem;
}

using ProblemOf = iga::Problem (*)(const VectorX&);

std::vector<std::optional<ProblemChange>> changes_at(const VectorX& point, ProblemOf problem_of) {
    std::vector<std::optional<ProblemChange>> changes(6);
    for (const int i : all) {
        const Parameter& one = model().parameters().parameters()[i];
        const double step = 1e-5 * (one.upper - one.lower);
        const VectorX shift = step * VectorX::Unit(6, i);
        changes[i] = {step, problem_of(point - shift), problem_of(point + shift)};
    }
    return changes;
}

FieldSamples samples_at(const VectorX& point, ProblemOf problem_of) {
    const Evaluation evaluation = model().evaluate(point);
    return FieldSampler(model().space(), grids())
        .sample(evaluation.control_points, evaluation.displacement, problem_of(point));
}

}  // namespace

TEST_CASE("GradientSampler: values of FieldSampler, derivatives of differences", "[rom]") {
    const ProblemOf problem_of = GENERATE(BoxFamily::problem, warm, rubber);
    const GradientSampler sampler(model().space(), grids());
    const SampleGradients there =
        sampler.sample(model().evaluate(somewhere()), model().gradient(somewhere()),
                       problem_of(somewhere()), changes_at(somewhere(), problem_of), all);
    const FieldSamples expected = samples_at(somewhere(), problem_of);
    CHECK((there.von_mises - expected.von_mises).norm() < 1e-10 * expected.von_mises.norm());
    const VectorX lengths = expected.displacements.colwise().norm();
    CHECK((there.displacement - lengths).norm() < 1e-12 * lengths.norm());
    for (const int i : all) {
        const Parameter& one = model().parameters().parameters()[i];
        const double range = one.upper - one.lower;
        const VectorX shift = 1e-4 * range * VectorX::Unit(6, i);
        const FieldSamples above = samples_at(somewhere() + shift, problem_of);
        const FieldSamples below = samples_at(somewhere() - shift, problem_of);
        const VectorX slope = (above.von_mises - below.von_mises) / 2e-4;
        CAPTURE(one.name);
        CHECK((range * there.von_mises_gradient.col(i) - slope).cwiseAbs().maxCoeff() <
              1e-5 * there.von_mises.maxCoeff());
        const VectorX u_slope =
            (above.displacements.colwise().norm() - below.displacements.colwise().norm())
                .transpose() /
            2e-4;
        CHECK((range * there.displacement_gradient.col(i) - u_slope).cwiseAbs().maxCoeff() <
              1e-6 * lengths.maxCoeff());
    }
}

TEST_CASE("GradientSampler: derivatives that are not asked for are 0", "[rom]") {
    const GradientSampler sampler(model().space(), grids());
    const SampleGradients there = sampler.sample(
        model().evaluate(somewhere()), model().gradient(somewhere()),
        BoxFamily::problem(somewhere()), std::vector<std::optional<ProblemChange>>(6), {1});
    CHECK(there.von_mises_gradient.col(0).isZero(0.0));
    CHECK(there.von_mises_gradient.col(1).norm() > 0.0);
    CHECK_THROWS_WITH(
        sampler.sample(model().evaluate(somewhere()), {}, BoxFamily::problem(somewhere()), {}, {}),
        Contains("0 changes of the problem for 6 parameters"));
}
