#include "rom/kriging_inputs.h"

#include <catch2/catch.hpp>

#include "iga/core/error.h"

using namespace couture;
using namespace couture::rom;

namespace {

ParameterSpace phase_and_load() {
    return ParameterSpace({{"length", ParameterGroup::geometry, "mm", 1.0, 3.0},
                           {"phase", ParameterGroup::geometry, "", 0.0, 20.0, true},
                           {"load", ParameterGroup::load, "N", 1.0, 2.0}});
}

}  // namespace

TEST_CASE("KrigingInputs: a periodic parameter is a point of a circle", "[rom]") {
    const ParameterSpace space = phase_and_load();
    const KrigingInputs inputs(space, {0, 1});
    REQUIRE(inputs.size() == 3);
    CHECK(inputs.parameters() == std::vector<int>{0, 1, 1});
    const Vector3 unit(0.25, 0.125, 0.5);
    const VectorX at = inputs.at(unit);
    CHECK(at[0] == 0.25);
    CHECK(at[1] == Approx(0.5 + 0.5 * std::sqrt(0.5)));
    CHECK(at[2] == Approx(0.5 + 0.5 * std::sqrt(0.5)));
    CHECK((inputs.at(Vector3(0.25, 1.125, 0.5)) - at).norm() < 1e-15);
    CHECK((inputs.at(Vector3(0.0, 1.0, 0.0)) - inputs.at(Vector3::Zero())).norm() < 1e-15);
    const MatrixX design = inputs.of_design((MatrixX(2, 2) << 0.25, 0.125, 0.0, 0.75).finished());
    CHECK((design.row(0).transpose() - at).norm() < 1e-15);
    CHECK(design(1, 2) == Approx(0.0).margin(1e-15));
}

TEST_CASE("KrigingInputs: slopes are those of finite differences", "[rom]") {
    const KrigingInputs inputs(phase_and_load(), {0, 1, 2});
    const Vector3 unit(0.3, 0.41, 0.7);
    const VectorX slopes = inputs.slopes(unit);
    const std::vector<int> of = inputs.parameters();
    constexpr double h = 1e-6;
    for (int i = 0; i < inputs.size(); ++i) {
        const Vector3 step = h * Vector3::Unit(of[i]);
        const double difference = (inputs.at(unit + step)[i] - inputs.at(unit - step)[i]) / (2 * h);
        CAPTURE(i);
        CHECK(slopes[i] == Approx(difference).epsilon(1e-8).margin(1e-8));
    }
}

TEST_CASE("ParameterSpace: no point is outside of a period, and loads have none", "[rom]") {
    const ParameterSpace space = phase_and_load();
    CHECK(space.distance_outside(Vector3(2.0, 27.0, 1.5)) == 0.0);
    CHECK(space.distance_outside(Vector3(4.0, 27.0, 1.5)) == Approx(0.5));
    CHECK_THROWS_AS(ParameterSpace({{"load", ParameterGroup::load, "N", 1.0, 2.0, true}}),
                    InputError);
}
