#include "rom/stress_gradient.h"

#include <catch2/catch.hpp>

#include "iga/core/error.h"
#include "iga/post/stress.h"
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

const Vector3 xi(0.3, 0.9, 0.2);

VectorX somewhere() { return BoxFamily::point({0.3, 0.7, 0.9, 0.2, 0.1, 0.6}); }

/// Central differences of the stiffness.
std::vector<iga::ElasticStiffness> stiffness_slopes(const VectorX& point) {
    std::vector<iga::ElasticStiffness> slopes;
    for (int i = 0; i < 6; ++i) {
        const double step = 1e-6 * point[i];
        VectorX moved = point;
        const auto stiffness = [&](double value) {
            moved[i] = value;
            return BoxFamily::problem(moved).materials[0].stiffness;
        };
        slopes.push_back((stiffness(point[i] + step) - stiffness(point[i] - step)) / (2.0 * step));
    }
    return slopes;
}

StressGradient at(const VectorX& point, const iga::Problem& problem,
                  const std::vector<iga::ElasticStiffness>& slopes, int patch) {
    return stress_gradient(model(), model().evaluate(point), model().gradient(point), problem,
                           slopes, patch, xi);
}

/// Compares with central differences; `problem_of` gives the problem at a point.
template <typename ProblemOf>
void compare(const ProblemOf& problem_of, const std::vector<iga::ElasticStiffness>& slopes) {
    const int patch = GENERATE(0, 1);
    const StressGradient there = at(somewhere(), problem_of(somewhere()), slopes, patch);
    for (int i = 0; i < 6; ++i) {
        const Parameter& parameter = model().parameters().parameters()[i];
        const double step = 1e-4 * (parameter.upper - parameter.lower);
        VectorX high = somewhere();
        VectorX low = somewhere();
        high[i] += step;
        low[i] -= step;
        const StressGradient above = at(high, problem_of(high), {}, patch);
        const StressGradient below = at(low, problem_of(low), {}, patch);
        const double range = parameter.upper - parameter.lower;
        const double scale = 1e-4 * there.von_mises;
        CHECK(std::abs(there.von_mises_gradient[i] -
                       (above.von_mises - below.von_mises) / (2.0 * step)) *
                  range <
              scale);
        CHECK((there.stress_gradient.col(i) - (above.stress - below.stress) / (2.0 * step)).norm() *
                  range <
              scale);
        CHECK((there.position_gradient.col(i) - (above.position - below.position) / (2.0 * step))
                      .norm() *
                  range <
              1e-6);
    }
}

}  // namespace

TEST_CASE("stress_gradient: the stress is that of stress_at on the predicted member", "[rom]") {
    const Evaluation evaluation = model().evaluate(somewhere());
    const iga::Problem problem = BoxFamily::problem(somewhere());
    const Vector<6> expected =
        iga::stress_at<3>(problem, model().displacement_field(evaluation), "", 1, xi).stress;
    const StressGradient there = at(somewhere(), problem, {}, 1);
    CHECK((there.stress - expected).norm() < 1e-10 * expected.norm());
    CHECK(there.von_mises == Approx(iga::von_mises(expected)));
    CHECK((there.position - model().member(evaluation).patches[1].point(xi)).norm() < 1e-12);
}

TEST_CASE("stress_gradient: derivatives agree with differences", "[rom]") {
    compare(BoxFamily::problem, stiffness_slopes(somewhere()));
}

TEST_CASE("stress_gradient: derivatives of hyperelastic stresses", "[rom]") {
    compare(
        [](const VectorX& point) {
            iga::Problem problem = BoxFamily::problem(point);
            // Fixed moduli: their slopes are not asked for.
            problem.materials[0].hyperelastic =
                iga::make_hyperelastic(iga::StoredEnergy::neo_hookean, 8e4, 2e5);
            return problem;
        },
        {});
}

TEST_CASE("stress_gradient: refuses what does not fit", "[rom]") {
    const iga::Problem problem = BoxFamily::problem(somewhere());
    CHECK_THROWS_WITH(at(somewhere(), problem, {}, 2), Contains("patch 2 does not exist"));
    CHECK_THROWS_WITH(at(somewhere(), problem, {iga::ElasticStiffness::Zero()}, 0),
                      Contains("1 slopes of the stiffness for 6 parameters"));
    iga::Problem warm = problem;
    warm.temperatures.resize(1);
    CHECK_THROWS_WITH(at(somewhere(), warm, {}, 0), Contains("without temperatures"));
    iga::Problem rubber = problem;
    rubber.materials[0].hyperelastic =
        iga::make_hyperelastic(iga::StoredEnergy::neo_hookean, 1.0, 2.0);
    CHECK_THROWS_WITH(at(somewhere(), rubber, stiffness_slopes(somewhere()), 0),
                      Contains("'steel' is hyperelastic"));
}
