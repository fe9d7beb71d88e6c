#include "io/units.h"

#include <catch2/catch.hpp>

#include "iga/core/error.h"

using namespace couture;
using namespace couture::io;

namespace {

/// Conversions are a few products of factors that are not exact in binary.
constexpr double rounding = 1e-14;

double convert(const std::string& text, const Dimension& dimension, const std::string& system) {
    return parse_quantity(text, dimension, UnitSystem(system));
}

std::string error_of(const std::string& text, const Dimension& dimension) {
    try {
        static_cast<void>(parse_quantity(text, dimension, UnitSystem()));
    } catch (const InputError& error) {
        return error.what();
    }
    return "no error";
}

}  // namespace

TEST_CASE("units: quantities are converted into the system of the deck", "[io]") {
    using namespace dimensions;
    CHECK(convert("210 GPa", pressure, "mm N MPa") == Approx(210e3).epsilon(rounding));
    CHECK(convert("210 GPa", pressure, "SI") == Approx(210e9).epsilon(rounding));
    CHECK(convert("210GPa", pressure, "m kN kPa") == Approx(210e6).epsilon(rounding));
    CHECK(convert("20 cm", length, "mm N MPa") == Approx(200.0).epsilon(rounding));
    CHECK(convert("1 in", length, "mm N MPa") == Approx(25.4).epsilon(rounding));
    CHECK(convert("1000 psi", pressure, "in lbf psi") == Approx(1000.0).epsilon(rounding));
    CHECK(convert("1e-5 1/K", expansion, "mm N MPa") == Approx(1e-5).epsilon(rounding));
    CHECK(convert("1e-5 /K", expansion, "mm N MPa") == Approx(1e-5).epsilon(rounding));
    CHECK(convert("3 N/mm^2", pressure, "SI") == Approx(3e6).epsilon(rounding));
    CHECK(convert("50 W/(m K)", conductivity, "SI") == Approx(50.0).epsilon(rounding));
    CHECK(convert("-2 kN m", moment, "mm N MPa") == Approx(-2e6).epsilon(rounding));
    CHECK(convert("7850 kg m^-3 * m s^-2", force_per_volume, "SI") ==
          Approx(7850.0).epsilon(rounding));
}

TEST_CASE("units: what is no quantity is left to the expressions", "[io]") {
    for (const char* text : {"2 * x", "10", "sin(x)", "1 / x", "3 - y", "", "x"}) {
        CAPTURE(text);
        CHECK_FALSE(looks_like_quantity(text));
    }
    CHECK(looks_like_quantity("+2 MPa"));
    CHECK(looks_like_quantity("2 furlong"));
}

TEST_CASE("units: mistakes name the unit and both dimensions", "[io]") {
    CHECK(error_of("3 mm", dimensions::pressure) == "'3 mm' is a length, expected a pressure");
    CHECK(error_of("3 N mm^-3 K", dimensions::pressure) ==
          "'3 N mm^-3 K' is length^-3 force temperature, expected a pressure");
    CHECK(error_of("3 MPA", dimensions::pressure) == "unknown unit 'MPA'; did you mean 'MPa'?");
    CHECK(error_of("3 furlong", dimensions::length) == "unknown unit 'furlong'");
    CHECK(error_of("3 N/", dimensions::length) ==
          "unit 'N/' can't be read at ''; write for example N/mm^2 or W/(m K)");
    CHECK_THROWS_WITH(UnitSystem("imperial"),
                      "unknown system of units 'imperial'; there are 'mm N MPa', 'm N Pa', 'SI', "
                      "'m kN kPa', 'm MN MPa', 'in lbf psi'");
}
