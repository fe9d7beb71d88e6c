#include "iga/mechanics/problem.h"

#include <catch2/catch.hpp>

using namespace couture;
using namespace couture::iga;

TEST_CASE("Amplitude: linear between its times, constant beyond them", "[mechanics]") {
    const Amplitude table{"ramp", {1.0, 2.0, 4.0}, {3.0, -1.0, 5.0}};
    CHECK(table(0.0) == 3.0);
    CHECK(table(1.0) == 3.0);
    CHECK(table(1.25) == Approx(2.0));
    CHECK(table(2.0) == -1.0);
    CHECK(table(3.0) == Approx(2.0));
    CHECK(table(4.0) == 5.0);
    CHECK(table(9.0) == 5.0);
    CHECK(Amplitude{"one", {0.5}, {2.0}}(0.1) == 2.0);
}

TEST_CASE("at_time: loads grow linearly, follow t, or follow a table", "[mechanics]") {
    Problem problem;
    problem.pressures = {make_pressure("a", 8.0), make_pressure("b", 8.0), make_pressure("c", 8.0)};
    problem.pressures[1].follows_time = true;
    problem.pressures[1].value = [](const Vector3& x, double t) { return x[0] * t; };
    problem.pressures[2].amplitude = Amplitude{"table", {0.0, 1.0}, {1.0, 3.0}};
    problem.point_loads.resize(1);
    problem.point_loads[0].force = Vector3(4.0, 0.0, 0.0);
    problem.point_loads[0].amplitude = problem.pressures[2].amplitude;
    const Problem now = at_time(problem, 0.5, 2.0);
    const Vector3 x(10.0, 0.0, 0.0);
    // The time is that of the problem, whatever is asked for later.
    CHECK(now.pressures[0].value(x, 7.0) == 2.0);
    CHECK(now.pressures[1].value(x, 7.0) == 5.0);
    CHECK(now.pressures[2].value(x, 7.0) == 16.0);
    CHECK(now.point_loads[0].force == Vector3(8.0, 0.0, 0.0));
}
