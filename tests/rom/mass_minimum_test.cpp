#include "rom/mass_minimum.h"

#include <catch2/catch.hpp>

#include "iga/core/error.h"
#include "rom/field_sampler.h"
#include "rom/member_geometry.h"
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

constexpr double density = 7.85e-9;

const MemberMeasures& measures() {
    static const MemberMeasures made(model(), BoxFamily::problem, VectorX::Constant(2, density),
                                     grids());
    return made;
}

VectorX somewhere() { return BoxFamily::point({0.3, 0.7, 0.9, 0.2, 0.1, 0.6}); }

struct Largest {
    double mass = 0.0;
    double von_mises = 0.0;
    double displacement = 0.0;
};

Largest largest_at(const VectorX& point) {
    static const FieldSampler sampler(model().space(), grids());
    const Evaluation evaluation = model().evaluate(point);
    const FieldSamples samples = sampler.sample(evaluation.control_points, evaluation.displacement,
                                                BoxFamily::problem(point));
    return {density * iga::volume(model().member(evaluation)), samples.von_mises.maxCoeff(),
            samples.displacements.colwise().norm().maxCoeff()};
}

const std::vector<int> shape = {BoxFamily::width, BoxFamily::taper};

}  // namespace

TEST_CASE("MemberMeasures: derivatives agree with differences", "[rom]") {
    const std::vector<int> all = {0, 1, 2, 3, 4, 5};
    constexpr double sharpness = 30.0;
    const MassLimits limits{.von_mises = 20.0, .displacement = 1e-3};
    const auto there = measures().at(somewhere(), limits, all, sharpness);
    const Largest expected = largest_at(somewhere());
    CHECK(there.mass.value == Approx(expected.mass).epsilon(1e-12));
    CHECK(there.von_mises->largest == Approx(expected.von_mises / 20.0).epsilon(1e-10));
    CHECK(there.displacement->largest == Approx(expected.displacement / 1e-3).epsilon(1e-10));
    for (const int i : all) {
        const Parameter& one = model().parameters().parameters()[i];
        const double step = 1e-4 * (one.upper - one.lower);
        const VectorX shift = step * VectorX::Unit(6, i);
        const auto above = measures().at(somewhere() + shift, limits, {}, sharpness);
        const auto below = measures().at(somewhere() - shift, limits, {}, sharpness);
        const double range = one.upper - one.lower;
        CAPTURE(one.name);
        CHECK(range * there.mass.gradient[i] ==
              Approx((above.mass.value - below.mass.value) / 2e-4).margin(1e-6 * expected.mass));
        CHECK(range * there.von_mises->smooth.gradient[i] ==
              Approx((above.von_mises->smooth.value - below.von_mises->smooth.value) / 2e-4)
                  .margin(1e-5 * there.von_mises->largest));
        CHECK(range * there.displacement->smooth.gradient[i] ==
              Approx((above.displacement->smooth.value - below.displacement->smooth.value) / 2e-4)
                  .margin(1e-5 * there.displacement->largest));
    }
}

TEST_CASE("minimize_mass: the best of a dense scan is no lighter", "[rom]") {
    const VectorX start = somewhere();
    // Of the lightest members the limits exclude some; each limit is the one that counts once.
    const Largest middle = largest_at(start);
    const bool is_stress = GENERATE(true, false);
    MassLimits limits;
    limits.von_mises = (is_stress ? 1.02 : 3.0) * middle.von_mises;
    limits.displacement = (is_stress ? 3.0 : 1.05) * middle.displacement;
    const MassMinimum found = minimize_mass(measures(), start, shape, limits, {.n_starts = 4});
    REQUIRE(found.is_feasible);
    const MassSearch& best = found.searches[found.best];
    const Largest at_best = largest_at(best.point);
    CHECK(best.mass == Approx(at_best.mass).epsilon(1e-10));
    // The largest values are within the limits, and one is at its limit.
    const double ratio = std::max(at_best.von_mises / *limits.von_mises,
                                  at_best.displacement / *limits.displacement);
    CHECK(ratio <= 1.0 + mass_tolerance);
    CHECK(ratio > 0.998);
    CHECK(best.point.tail(4) == start.tail(4));

    double lightest = 1e300;
    constexpr int n = 24;
    for (int i = 0; i <= n; ++i) {
        for (int j = 0; j <= n; ++j) {
            VectorX unit = model().parameters().to_unit(start);
            unit[BoxFamily::width] = static_cast<double>(i) / n;
            unit[BoxFamily::taper] = static_cast<double>(j) / n;
            const Largest one = largest_at(model().parameters().from_unit(unit));
            if (one.von_mises <= *limits.von_mises && one.displacement <= *limits.displacement) {
                lightest = std::min(lightest, one.mass);
            }
        }
    }
    CAPTURE(best.point.transpose(), best.mass / lightest, ratio);
    // Smooth maxima are above the largest value by log(n) / 3000 at most.
    CHECK(best.mass <= lightest * (1.0 + 2e-3));
    // A step of the scan changes the mass by about 2 %.
    CHECK(best.mass >= lightest * (1.0 - 2e-2));
}

TEST_CASE("minimize_mass: limits that can't be kept leave the least violation", "[rom]") {
    const VectorX start = somewhere();
    const double limit = 0.3 * largest_at(start).von_mises;
    const MassMinimum found =
        minimize_mass(measures(), start, shape, {.von_mises = limit}, {.n_starts = 3});
    CHECK_FALSE(found.is_feasible);
    const MassSearch& best = found.searches[found.best];
    double least = 1e300;
    constexpr int n = 20;
    for (int i = 0; i <= n; ++i) {
        for (int j = 0; j <= n; ++j) {
            VectorX unit = model().parameters().to_unit(start);
            unit[BoxFamily::width] = static_cast<double>(i) / n;
            unit[BoxFamily::taper] = static_cast<double>(j) / n;
            const double stress = largest_at(model().parameters().from_unit(unit)).von_mises;
            least = std::min(least, stress / limit - 1.0);
        }
    }
    CHECK(best.violation <= least + 1e-3);
    CHECK(best.violation >= least - 0.05);
}

TEST_CASE("minimize_mass: the same seed gives the same searches", "[rom]") {
    const double limit = largest_at(somewhere()).von_mises;
    const auto run = [&](std::uint64_t seed) {
        return minimize_mass(measures(), somewhere(), shape, {.von_mises = limit},
                             {.n_starts = 3, .seed = seed});
    };
    const MassMinimum one = run(7);
    const MassMinimum other = run(7);
    for (int i = 0; i < 3; ++i) {
        CHECK(one.searches[i].start == other.searches[i].start);
        CHECK(one.searches[i].point == other.searches[i].point);
    }
    CHECK(one.searches[0].start.isApprox(somewhere(), 1e-14));
}

TEST_CASE("minimize_mass: refuses what makes no problem", "[rom]") {
    const VectorX start = somewhere();
    CHECK_THROWS_WITH(minimize_mass(measures(), start, shape, {}), Contains("no limit"));
    CHECK_THROWS_WITH(minimize_mass(measures(), start, {}, {.von_mises = 1.0}),
                      Contains("no parameter is free"));
    CHECK_THROWS_WITH(minimize_mass(measures(), start, shape, {.von_mises = 0.0}),
                      Contains("limit of 0; it must be positive"));
    CHECK_THROWS_WITH(minimize_mass(measures(), start, shape, {.von_mises = 1.0}, {.n_starts = 0}),
                      Contains("0 starts"));
    CHECK_THROWS_WITH(MemberMeasures(model(), BoxFamily::problem, VectorX::Ones(3), grids()),
                      Contains("3 densities for 2 patches"));
}
