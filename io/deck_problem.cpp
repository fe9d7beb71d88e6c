#include <fmt/format.h>

#include <algorithm>

#include "io/deck_readers.h"
#include "io/did_you_mean.h"

namespace couture::io {

namespace {

void read_analysis(Section& section, iga::Problem& problem) {
    static const std::vector<std::string> types = {"elasticity", "poisson"};
    static const std::vector<std::string> names = {"solid", "plane_strain", "plane_stress",
                                                   "axisymmetric"};
    if (section.choice("type", types).value_or("elasticity") == "poisson") {
        problem.physics = iga::Physics::poisson;
    }
    const std::string kinematics = section.choice("kinematics", names).value_or("solid");
    problem.kinematics = static_cast<iga::Kinematics>(
        std::find(names.begin(), names.end(), kinematics) - names.begin());
    section.context().is_plane = problem.kinematics != iga::Kinematics::solid;
    problem.thickness =
        section.number("thickness", dimensions::length, positive).value_or(problem.thickness);
    const bool is_plane = problem.kinematics == iga::Kinematics::plane_strain ||
                          problem.kinematics == iga::Kinematics::plane_stress;
    if (section.has("thickness") && !is_plane) {
        section.mistake("thickness", fmt::format("'thickness' of [analysis] holds for kinematics "
                                                 "'plane_strain' and 'plane_stress', not for '{}'",
                                                 kinematics));
    }
}

void read_combinations(Section& top, iga::Problem& problem) {
    const std::vector<std::string> cases = problem.load_cases();
    for_each_named(top, "combination", [&](const std::string& name, Section& section) {
        if (name.find_first_of("/\\") != std::string::npos || name.starts_with('.')) {
            section.mistake("", fmt::format("{} can't name a result file; take letters, digits, "
                                            "spaces, '-' and '_'",
                                            section.title()));
        }
        if (section.table().entries.empty()) {
            section.mistake(
                "", fmt::format("{} is empty; give load cases and their factors", section.title()));
        }
        for (const auto& [load_case, node] : section.table().entries) {
            const auto factor = section.number(load_case, dimensions::none);
            if (std::find(cases.begin(), cases.end(), load_case) == cases.end()) {
                section.mistake(load_case,
                                fmt::format("{} names the load case '{}', which no load belongs "
                                            "to; there are {}",
                                            section.title(), load_case, quoted_list(cases)));
            }
            problem.combinations[name][load_case] = factor.value_or(0.0);
        }
        if (std::find(cases.begin(), cases.end(), name) != cases.end()) {
            section.mistake("", fmt::format("[combination.{0}]: '{0}' is the name of a load case; "
                                            "give the combination another",
                                            name));
        }
    });
}

/// What hyperelastic bodies do not have.
void refuse_linear_only(Section& top, const iga::Problem& problem) {
    if (!top.context().is_hyperelastic) {
        return;
    }
    if (problem.kinematics == iga::Kinematics::plane_stress) {
        top.context().mistakes.add(
            top.find("analysis")->find("kinematics")->place,
            "kinematics 'plane_stress' is for linear materials only; with hyperelastic ones take "
            "'plane_strain', 'axisymmetric' or a volume");
    }
    if (top.has("combination")) {
        top.mistake("combination",
                    "[combination.NAME] adds load cases, which hyperelastic bodies do not have; "
                    "leave it out");
    }
    if (top.has("temperature")) {
        top.mistake("temperature",
                    "[[temperature]]: hyperelastic materials have no thermal strain; leave it out");
    }
}

}  // namespace

void read_problem(Section& top, iga::Problem& problem) {
    if (const TomlNode* analysis = top.find("analysis")) {
        if (analysis->kind == TomlNode::Kind::table) {
            Section section(*analysis, "[analysis]", top.context());
            read_analysis(section, problem);
            section.finish();
        } else {
            top.mistake("analysis", fmt::format("'analysis' is {}, expected a section [analysis]",
                                                analysis->kind_name()));
        }
    }
    read_materials(top, problem);
    read_amplitudes(top);
    read_conditions(top, problem);
    read_loads(top, problem);
    read_combinations(top, problem);
    refuse_linear_only(top, problem);
    for (const auto& [place, name] : top.context().uses_of_time) {
        if (top.context().is_hyperelastic) {
            break;
        }
        top.context().mistakes.add(
            place,
            fmt::format("{} depends on the time t, which linear analyses do not have; write a "
                        "load case for each time",
                        name));
    }
    // What belongs to the other type of analysis is a mistake of its own, not an unknown section.
    static const std::vector<std::string> elastic = {
        "symmetry",   "fixed",      "displacement", "pressure",   "traction",
        "body_force", "point_load", "resultant",    "foundation", "temperature"};
    static const std::vector<std::string> poisson = {"potential", "flux", "source"};
    const bool is_elasticity = problem.physics == iga::Physics::elasticity;
    for (const std::string& name : is_elasticity ? poisson : elastic) {
        if (top.table().find(name) != nullptr && top.has(name)) {
            top.mistake(name, fmt::format("[[{}]] belongs to analysis type '{}'; the type of this "
                                          "deck is '{}'",
                                          name, is_elasticity ? "poisson" : "elasticity",
                                          is_elasticity ? "elasticity" : "poisson"));
        }
    }
}

}  // namespace couture::io
