#pragma once

#include <array>
#include <string>
#include <string_view>

namespace couture::io {

/// Exponents of a physical quantity in length, force, time and temperature. Mass is force time^2 /
/// length, heat is force times length. Angles are pure numbers.
struct Dimension {
    int length = 0;
    int force = 0;
    int time = 0;
    int temperature = 0;

    bool operator==(const Dimension&) const = default;
    /// "pressure", "length", ..., or "length^2 force^-1".
    [[nodiscard]] std::string name() const;
};

namespace dimensions {
constexpr Dimension none{};
constexpr Dimension length{.length = 1};
constexpr Dimension area{.length = 2};
constexpr Dimension volume{.length = 3};
constexpr Dimension force{.force = 1};
constexpr Dimension moment{.length = 1, .force = 1};
constexpr Dimension pressure{.length = -2, .force = 1};
constexpr Dimension force_per_volume{.length = -3, .force = 1};
constexpr Dimension density{.length = -4, .force = 1, .time = 2};
constexpr Dimension mass{.length = -1, .force = 1, .time = 2};
constexpr Dimension time{.time = 1};
constexpr Dimension temperature{.temperature = 1};
constexpr Dimension expansion{.temperature = -1};
constexpr Dimension conductivity{.force = 1, .time = -1, .temperature = -1};
constexpr Dimension heat_flux{.length = -1, .force = 1, .time = -1};
constexpr Dimension heat_source{.length = -2, .force = 1, .time = -1};
}  // namespace dimensions

/// A value in metre, newton, second, kelvin and its dimension.
struct Quantity {
    double value = 0.0;
    Dimension dimension;
};

/// "GPa", "N/mm^2", "1/K", "W/(m K)", ... as a multiple of metre, newton, second, kelvin.
///
/// @throws InputError  naming the part that is no unit, and the nearest one
[[nodiscard]] Quantity parse_unit(std::string_view text);

/// The consistent units that a deck's plain numbers are in.
class UnitSystem {
  public:
    /// "mm N MPa", "m N Pa" (also "SI"), "m kN kPa", "m MN MPa", "in lbf psi"; seconds and kelvin.
    /// @throws InputError  for another name: lists these
    explicit UnitSystem(const std::string& name = "mm N MPa");

    [[nodiscard]] const std::string& name() const { return name_; }
    /// "mm", "N", "MPa": its length, force and pressure.
    [[nodiscard]] std::array<std::string, 3> unit_names() const;
    /// One of this system's units of that dimension in metre, newton, second, kelvin.
    [[nodiscard]] double scale(const Dimension& dimension) const;

  private:
    std::string name_;
    double length_ = 1.0;
    double force_ = 1.0;
};

/// True if a text reads as a number followed by a unit ("210 GPa", "1e-5 1/K"), not as an
/// expression.
[[nodiscard]] bool looks_like_quantity(std::string_view text);

/// The number and its unit of a text that looks like a quantity, converted to `system`.
///
/// @throws InputError  if the unit is unknown or not of `expected`: names both dimensions
[[nodiscard]] double parse_quantity(std::string_view text, const Dimension& expected,
                                    const UnitSystem& system);

}  // namespace couture::io
