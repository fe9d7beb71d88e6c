#include <fmt/format.h>

#include <algorithm>

#include "io/deck_readers.h"

namespace couture::io {

namespace {

iga::Support make_support(Section& section, const std::string& on) {
    iga::Support support;
    support.source = section.place().source;
    support.on = on;
    return support;
}

void read_displacement(Section& section, iga::Problem& problem) {
    const std::vector<std::string> sets = section.sets();
    const std::string load_case = section.load_case();
    const auto components = section.components("value", dimensions::length);
    const auto normal = section.function("normal", dimensions::length);
    const bool has_component = std::any_of(components.begin(), components.end(),
                                           [](const auto& c) { return c.has_value(); });
    const bool asks_component =
        section.has("value") || section.has("x") || section.has("y") || section.has("z");
    if (asks_component == section.has("normal")) {
        section.mistake("", fmt::format("{} needs either 'normal', or 'value' or some of 'x', 'y', "
                                        "'z'",
                                        section.title()));
        return;
    }
    iga::CaseEntry time;
    read_time(section, time);
    for (const std::string& on : sets) {
        iga::Support support = make_support(section, on);
        support.load_case = load_case;
        support.follows_time = time.follows_time;
        support.amplitude = time.amplitude;
        support.normal = normal;
        if (has_component) {
            support.components = components;
        }
        problem.supports.push_back(std::move(support));
    }
}

void read_fixed(Section& section, iga::Problem& problem) {
    static const std::vector<std::string> axes = {"x", "y", "z"};
    std::vector<std::string> directions = section.texts("directions");
    for (const std::string& direction : directions) {
        if (std::find(axes.begin(), axes.end(), direction) == axes.end()) {
            section.mistake("directions", fmt::format("unknown direction '{}'; there are 'x', 'y', "
                                                      "'z'",
                                                      direction));
        }
    }
    section.refuse_third("directions",
                         std::find(directions.begin(), directions.end(), "z") != directions.end());
    if (directions.empty()) {
        directions = axes;
    }
    // A plane body has no third displacement to hold.
    const bool is_solid = problem.kinematics == iga::Kinematics::solid;
    for (const std::string& on : section.sets()) {
        iga::Support support = make_support(section, on);
        for (std::size_t i = 0; i < (is_solid ? 3U : 2U); ++i) {
            if (std::find(directions.begin(), directions.end(), axes[i]) != directions.end()) {
                support.components[i] = constant(0.0);
            }
        }
        problem.supports.push_back(std::move(support));
    }
}

void read_foundation(Section& section, iga::Problem& problem) {
    constexpr Dimension stiffness{.length = -3, .force = 1};
    const auto components = section.components("value", stiffness);
    const auto normal = section.function("normal", stiffness);
    if (!section.has("normal") && !section.has("value") && !section.has("x") && !section.has("y") &&
        !section.has("z")) {
        section.mistake("", fmt::format("{} needs 'normal', 'value' or some of 'x', 'y', 'z' "
                                        "(stiffness per area)",
                                        section.title()));
    }
    if (section.names_time() && section.context().is_hyperelastic) {
        section.mistake("", fmt::format("{} depends on the time t; springs do not change, leave t "
                                        "out",
                                        section.title()));
    }
    for (const std::string& on : section.sets()) {
        iga::Foundation foundation;
        foundation.source = section.place().source;
        foundation.on = on;
        foundation.normal = normal;
        foundation.components = components;
        problem.foundations.push_back(std::move(foundation));
    }
}

void read_potential(Section& section, iga::Problem& problem) {
    section.require("value", "a number or an expression");
    const auto value = section.function("value", dimensions::temperature);
    const std::string load_case = section.load_case();
    for (const std::string& on : section.sets()) {
        iga::Support support = make_support(section, on);
        support.load_case = load_case;
        support.components[0] = value;
        problem.supports.push_back(std::move(support));
    }
}

}  // namespace

void read_conditions(Section& top, iga::Problem& problem) {
    if (problem.physics == iga::Physics::poisson) {
        for_each_entry(top, "potential",
                       [&](Section& section) { read_potential(section, problem); });
        return;
    }
    for_each_entry(top, "symmetry", [&](Section& section) {
        for (const std::string& on : section.sets()) {
            iga::Support support = make_support(section, on);
            support.normal = constant(0.0);
            problem.supports.push_back(std::move(support));
        }
    });
    for_each_entry(top, "fixed", [&](Section& section) { read_fixed(section, problem); });
    for_each_entry(top, "displacement",
                   [&](Section& section) { read_displacement(section, problem); });
    for_each_entry(top, "foundation", [&](Section& section) { read_foundation(section, problem); });
}

}  // namespace couture::io
