#include "meshing/parts/parts.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <limits>

#include "iga/core/error.h"
#include "tests/meshing/parts/part_probe.h"

namespace couture::meshing {

using Catch::Matchers::Contains;
using Catch::Matchers::Equals;

namespace {

template <int d>
int n_sets_with(const iga::MultiPatch<d>& part, const iga::PatchEntity<d>& side) {
    int count = 0;
    for (const auto& [name, entities] : part.boundary_sets) {
        // The half seal's cut_low and cut_high together.
        if (name == "cuts") {
            continue;
        }
        count += static_cast<int>(std::count(entities.begin(), entities.end(), side));
    }
    return count;
}

}  // namespace

TEST_CASE("parts: every part is a valid right-handed multipatch", "[parts]") {
    for (const PartInfo& info : parts()) {
        CAPTURE(info.name);
        std::visit(
            [&]<int d>(const iga::MultiPatch<d>& part) {
                CHECK(d == info.dimension);
                CHECK(part.dimension() == d);
                constexpr double rounding = 1e-14;
                CHECK_NOTHROW(iga::check(part, rounding));
                CHECK(smallest_jacobian(part, true) > 0.1);
            },
            make_part(info.name));
    }
}

TEST_CASE("parts: each outer side is in exactly one named set", "[parts]") {
    for (const PartInfo& info : parts()) {
        std::visit(
            [&]<int d>(const iga::MultiPatch<d>& part) {
                for (const iga::PatchEntity<d>& side : part.outer_sides()) {
                    CAPTURE(info.name, side.name());
                    CHECK(n_sets_with(part, side) == 1);
                }
            },
            make_part(info.name));
    }
}

TEST_CASE("parts: descriptions name all sets, and names are unique", "[parts]") {
    for (const PartInfo& info : parts()) {
        CAPTURE(info.name);
        CHECK(std::count_if(parts().begin(), parts().end(),
                            [&](const PartInfo& other) { return other.name == info.name; }) == 1);
        std::visit(
            [&](const auto& part) {
                for (const auto& [name, entities] : part.boundary_sets) {
                    CHECK_THAT(info.description, Contains(name));
                    CHECK_FALSE(entities.empty());
                }
            },
            make_part(info.name));
    }
}

TEST_CASE("parts: at both ends of each range the Jacobian is positive or the values are refused",
          "[parts]") {
    for (const PartInfo& info : parts()) {
        for (const PartParameter& parameter : info.parameters) {
            CHECK(parameter.min <= parameter.value);
            CHECK(parameter.value <= parameter.max);
            CHECK_FALSE(parameter.meaning_and_unit.empty());
            for (const double value : {parameter.min, parameter.max}) {
                CAPTURE(info.name, parameter.name, value);
                try {
                    std::visit(
                        [](const auto& part) {
                            iga::check(part);
                            CHECK(smallest_jacobian(part, false) > 0.0);
                        },
                        make_part(info.name, {{parameter.name, value}}));
                } catch (const InputError& error) {
                    CHECK_THAT(error.what(), Contains("is not smaller than"));
                }
            }
        }
    }
}

TEST_CASE("parts: the unit of length does not matter", "[parts]") {
    constexpr double scale = 16.0;
    for (const PartInfo& info : parts()) {
        CAPTURE(info.name);
        std::map<std::string, double> scaled;
        for (const PartParameter& parameter : info.parameters) {
            const bool is_angle_or_ratio = parameter.name == "twist" ||
                                           parameter.name == "half_angle" ||
                                           parameter.name == "core";
            scaled[parameter.name] = parameter.value * (is_angle_or_ratio ? 1.0 : scale);
        }
        // Cook's membrane has its shape in its name, the half seal's ranges are lengths in mm.
        if (info.name == "cook" || info.name == "cook_3d" || info.name == "half_seal") {
            continue;
        }
        std::visit(
            [&]<int d>(const iga::MultiPatch<d>& part) {
                const auto large = std::get<iga::MultiPatch<d>>(make_part(info.name, scaled));
                CHECK(iga::signature(large) == iga::signature(part));
                CHECK(large.size() == Approx(scale * part.size()));
            },
            make_part(info.name));
    }
}

TEST_CASE("parts: an unknown part or parameter is refused with the nearest name", "[parts]") {
    CHECK_THROWS_WITH(make_part("pipe_te"),
                      Contains("make_part: unknown part 'pipe_te'; did you mean 'pipe_tee'?") &&
                          Contains("hollow_sphere"));
    CHECK_THROWS_WITH(
        make_part("rectangle", {{"lenght_x", 1.0}}),
        Equals("rectangle: unknown parameter 'lenght_x'; did you mean 'length_x'? there are: "
               "length_x, length_y"));
    CHECK_THROWS_WITH(make_part("cook", {{"thickness", 1.0}}),
                      Contains("cook: unknown parameter 'thickness'"));
}

TEST_CASE("parts: values out of range or in contradiction are refused", "[parts]") {
    CHECK_THROWS_WITH(make_part("box", {{"length_y", -1.0}}),
                      Contains("box: length_y = -1 is out of range; it must lie in [0.001, "));
    CHECK_THROWS_AS(make_part("box", {{"length_y", std::numeric_limits<double>::quiet_NaN()}}),
                    InputError);
    CHECK_THROWS_WITH(make_part("pipe_tee", {{"inner_radius", 1.5}}),
                      Equals("pipe_tee: inner_radius = 1.5 is not smaller than outer_radius = 1; "
                             "make inner_radius smaller or outer_radius larger"));
    CHECK_THROWS_WITH(make_part("pipe_tee", {{"branch_length", 1.0}}),
                      Contains("outer_radius = 1 is not smaller than branch_length = 1"));
    CHECK_THROWS_WITH(make_part("pinched_cylinder", {{"thickness", 700.0}}),
                      Contains("thickness = 700 is not smaller than twice the radius = 300"));
}

}  // namespace couture::meshing
