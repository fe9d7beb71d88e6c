#include "rom/parameter_space.h"

#include <catch2/catch.hpp>
#include <limits>

#include "iga/core/error.h"

using namespace couture;
using namespace couture::rom;

namespace {

ParameterSpace seal() {
    return ParameterSpace({{"R1", ParameterGroup::geometry, "mm", 11.0, 15.0},
                           {"load", ParameterGroup::load, "N", 100.0, 175.0},
                           {"R2", ParameterGroup::geometry, "mm", 20.0, 30.0}});
}

}  // namespace

TEST_CASE("ParameterSpace: the unit cube and back", "[rom]") {
    const ParameterSpace space = seal();
    const VectorX point = (VectorX(3) << 12.0, 160.0, 31.0).finished();
    CHECK((space.from_unit(space.to_unit(point)) - point).norm() < 1e-12);
    CHECK(space.to_unit(point)[0] == Approx(0.25));
    CHECK(space.to_unit(point)[2] == Approx(1.1));
    CHECK(space.centre()[1] == Approx(137.5));
}

TEST_CASE("ParameterSpace: distance outside is that of the worst parameter", "[rom]") {
    const ParameterSpace space = seal();
    CHECK(space.distance_outside(space.centre()) == 0.0);
    CHECK(space.distance_outside((VectorX(3) << 10.0, 100.0, 31.0).finished()) == Approx(0.25));
}

TEST_CASE("ParameterSpace: groups and names", "[rom]") {
    const ParameterSpace space = seal();
    CHECK(space.group(ParameterGroup::geometry) == std::vector<int>{0, 2});
    CHECK(space.group(ParameterGroup::material).empty());
    CHECK(space.index_of("R2") == 2);
    CHECK_THROWS_WITH(space.index_of("laod"), Catch::Contains("did you mean 'load'"));
}

TEST_CASE("ParameterSpace: refuses what spans no box", "[rom]") {
    const auto made = [](double lower, double upper) {
        return ParameterSpace({{"a", ParameterGroup::load, "", lower, upper}});
    };
    CHECK_THROWS_WITH(made(2.0, 1.0), Catch::Contains("[2, 1] of 'a'"));
    CHECK_THROWS_AS(made(1.0, 1.0), InputError);
    CHECK_THROWS_AS(made(0.0, std::numeric_limits<double>::infinity()), InputError);
    CHECK_THROWS_WITH(ParameterSpace({}), Catch::Contains("no parameters"));
    const Parameter a{"a", ParameterGroup::load, "", 0.0, 1.0};
    CHECK_THROWS_WITH(ParameterSpace({a, a}), Catch::Contains("two parameters are called 'a'"));
}
