#include "io/units.h"

#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <map>
#include <sstream>
#include <utility>
#include <vector>

#include "iga/core/error.h"
#include "io/did_you_mean.h"

namespace couture::io {

namespace {

constexpr double inch = 0.0254;
/// The international pound and standard gravity.
constexpr double pound_force = 0.45359237 * 9.80665;
constexpr Dimension time_dimension{.time = 1};
constexpr Dimension energy = dimensions::moment;
constexpr Dimension power{.length = 1, .force = 1, .time = -1};

const std::map<std::string, Quantity>& units() {
    using namespace dimensions;
    static const std::map<std::string, Quantity> table = {
        {"m", {1.0, length}},
        {"mm", {1e-3, length}},
        {"cm", {1e-2, length}},
        {"um", {1e-6, length}},
        {"km", {1e3, length}},
        {"in", {inch, length}},
        {"ft", {12.0 * inch, length}},
        {"N", {1.0, force}},
        {"mN", {1e-3, force}},
        {"kN", {1e3, force}},
        {"MN", {1e6, force}},
        {"lbf", {pound_force, force}},
        {"Pa", {1.0, pressure}},
        {"kPa", {1e3, pressure}},
        {"MPa", {1e6, pressure}},
        {"GPa", {1e9, pressure}},
        {"bar", {1e5, pressure}},
        {"psi", {pound_force / (inch * inch), pressure}},
        {"ksi", {1e3 * pound_force / (inch * inch), pressure}},
        {"K", {1.0, temperature}},
        {"degC", {1.0, temperature}},
        {"s", {1.0, time_dimension}},
        {"ms", {1e-3, time_dimension}},
        {"kg", {1.0, mass}},
        {"g", {1e-3, mass}},
        {"J", {1.0, energy}},
        {"kJ", {1e3, energy}},
        {"W", {1.0, power}},
        {"kW", {1e3, power}},
        {"rad", {1.0, none}},
        {"deg", {std::acos(-1.0) / 180.0, none}},
        {"%", {1e-2, none}},
    };
    return table;
}

std::vector<std::string> unit_names() {
    std::vector<std::string> names;
    for (const auto& [name, unit] : units()) {
        names.push_back(name);
    }
    return names;
}

Quantity power_of(const Quantity& q, int n) {
    return {std::pow(q.value, n),
            {.length = n * q.dimension.length,
             .force = n * q.dimension.force,
             .time = n * q.dimension.time,
             .temperature = n * q.dimension.temperature}};
}

Quantity product(const Quantity& a, const Quantity& b) {
    return {a.value * b.value,
            {.length = a.dimension.length + b.dimension.length,
             .force = a.dimension.force + b.dimension.force,
             .time = a.dimension.time + b.dimension.time,
             .temperature = a.dimension.temperature + b.dimension.temperature}};
}

/// product := factor { ['*' | ' ' | '/'] factor };  factor := atom ['^' integer];
/// atom := name | '1' | '(' product ')'
class UnitParser {
  public:
    explicit UnitParser(std::string_view text) : text_(text) {}

    Quantity parse() {
        const Quantity result = parse_product();
        if (i_ < text_.size()) {
            fail();
        }
        return result;
    }

  private:
    static constexpr int max_nesting = 10;

    [[noreturn]] void fail() const {
        throw InputError("unit '{}' can't be read at '{}'; write for example N/mm^2 or W/(m K)",
                         text_, text_.substr(i_));
    }
    void skip_spaces() {
        while (i_ < text_.size() && text_[i_] == ' ') {
            ++i_;
        }
    }
    bool take(char c) {
        skip_spaces();
        if (i_ < text_.size() && text_[i_] == c) {
            ++i_;
            return true;
        }
        return false;
    }
    Quantity parse_product() {
        Quantity result = take('/') ? power_of(parse_factor(), -1) : parse_factor();
        for (;;) {
            skip_spaces();
            if (i_ == text_.size() || text_[i_] == ')') {
                return result;
            }
            const bool divides = take('/');
            if (!divides) {
                take('*');
            }
            result = product(result, power_of(parse_factor(), divides ? -1 : 1));
        }
    }
    Quantity parse_factor() {
        const Quantity atom = parse_atom();
        if (!take('^')) {
            return atom;
        }
        int exponent = 0;
        const char* end = text_.data() + text_.size();
        const auto [next, code] = std::from_chars(text_.data() + i_, end, exponent);
        if (code != std::errc() || std::abs(exponent) > 9) {
            fail();
        }
        i_ = static_cast<std::size_t>(next - text_.data());
        return power_of(atom, exponent);
    }
    Quantity parse_atom() {
        skip_spaces();
        if (take('(')) {
            if (++nesting_ > max_nesting) {
                fail();
            }
            const Quantity inner = parse_product();
            if (!take(')')) {
                fail();
            }
            return inner;
        }
        if (take('1')) {
            return {1.0, dimensions::none};
        }
        const std::size_t begin = i_;
        while (i_ < text_.size() &&
               (std::isalpha(static_cast<unsigned char>(text_[i_])) || text_[i_] == '%')) {
            ++i_;
        }
        const std::string name(text_.substr(begin, i_ - begin));
        if (name.empty()) {
            fail();
        }
        const auto unit = units().find(name);
        if (unit == units().end()) {
            throw InputError("unknown unit '{}'{}", name, did_you_mean(name, unit_names()));
        }
        return unit->second;
    }

    std::string_view text_;
    std::size_t i_ = 0;
    int nesting_ = 0;
};

struct NamedSystem {
    const char* name;
    double length;
    double force;
};
constexpr std::array<NamedSystem, 6> systems = {{{"mm N MPa", 1e-3, 1.0},
                                                 {"m N Pa", 1.0, 1.0},
                                                 {"SI", 1.0, 1.0},
                                                 {"m kN kPa", 1.0, 1e3},
                                                 {"m MN MPa", 1.0, 1e6},
                                                 {"in lbf psi", inch, pound_force}}};

/// Characters of `text` that are the number at its start; 0 if there is none.
std::size_t number_length(std::string_view text) {
    double number = 0.0;
    const std::size_t sign = !text.empty() && text[0] == '+' ? 1 : 0;
    const auto [end, code] = std::from_chars(text.data() + sign, text.data() + text.size(), number);
    return code == std::errc() ? static_cast<std::size_t>(end - text.data()) : 0;
}

std::string_view without_spaces_around(std::string_view text) {
    while (!text.empty() && text.front() == ' ') {
        text.remove_prefix(1);
    }
    while (!text.empty() && text.back() == ' ') {
        text.remove_suffix(1);
    }
    return text;
}

}  // namespace

std::string Dimension::name() const {
    using namespace dimensions;
    static const std::vector<std::pair<Dimension, const char*>> names = {
        {none, "a pure number"},
        {io::dimensions::length, "a length"},
        {area, "an area"},
        {volume, "a volume"},
        {io::dimensions::force, "a force"},
        {moment, "a moment (force times length)"},
        {pressure, "a pressure"},
        {force_per_volume, "a force per volume"},
        {density, "a density"},
        {io::dimensions::temperature, "a temperature"},
        {expansion, "a thermal expansion (1/temperature)"},
        {conductivity, "a conductivity"},
        {heat_flux, "a heat flux (power per area)"},
        {heat_source, "a heat source (power per volume)"},
        {time_dimension, "a time"},
        {mass, "a mass"},
        {power, "a power"},
        {{.length = -1, .force = 1}, "a force per length"}};
    for (const auto& [dimension, dimension_name] : names) {
        if (dimension == *this) {
            return dimension_name;
        }
    }
    std::string result;
    const std::array<std::pair<int, const char*>, 4> powers = {
        {{length, "length"}, {force, "force"}, {time, "time"}, {temperature, "temperature"}}};
    for (const auto& [exponent, base] : powers) {
        if (exponent != 0) {
            result += fmt::format("{}{}", result.empty() ? "" : " ", base);
            result += exponent == 1 ? "" : fmt::format("^{}", exponent);
        }
    }
    return result;
}

Quantity parse_unit(std::string_view text) { return UnitParser(text).parse(); }

UnitSystem::UnitSystem(const std::string& name) : name_(name) {
    std::string known;
    for (const NamedSystem& system : systems) {
        if (name == system.name) {
            length_ = system.length;
            force_ = system.force;
            return;
        }
        known += fmt::format("{}'{}'", known.empty() ? "" : ", ", system.name);
    }
    throw InputError("unknown system of units '{}'; there are {}", name, known);
}

std::array<std::string, 3> UnitSystem::unit_names() const {
    std::istringstream words(name_ == "SI" ? "m N Pa" : name_);
    std::array<std::string, 3> names;
    words >> names[0] >> names[1] >> names[2];
    return names;
}

double UnitSystem::scale(const Dimension& dimension) const {
    return std::pow(length_, dimension.length) * std::pow(force_, dimension.force);
}

bool looks_like_quantity(std::string_view text) {
    text = without_spaces_around(text);
    const std::size_t n = number_length(text);
    if (n == 0) {
        return false;
    }
    const std::string_view rest = without_spaces_around(text.substr(n));
    if (rest.empty()) {
        return false;
    }
    if (std::isalpha(static_cast<unsigned char>(rest[0])) || rest[0] == '%' || rest[0] == '1') {
        return true;
    }
    if (rest[0] != '/') {
        return false;
    }
    try {
        static_cast<void>(parse_unit(rest));
        return true;
    } catch (const InputError&) {
        return false;
    }
}

double parse_quantity(std::string_view text, const Dimension& expected, const UnitSystem& system) {
    text = without_spaces_around(text);
    const std::size_t n = number_length(text);
    double number = 0.0;
    std::from_chars(text.data() + (text[0] == '+' ? 1 : 0), text.data() + n, number);
    const std::string_view unit_text = without_spaces_around(text.substr(n));
    const Quantity unit = parse_unit(unit_text);
    if (unit.dimension != expected) {
        throw InputError("'{}' is {}, expected {}", text, unit.dimension.name(), expected.name());
    }
    return number * unit.value / system.scale(expected);
}

}  // namespace couture::io
