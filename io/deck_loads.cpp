#include <fmt/format.h>

#include "io/deck_readers.h"

namespace couture::io {

namespace {

template <typename Load>
Load make_load(Section& section) {
    Load load;
    load.source = section.place().source;
    load.load_case = section.load_case();
    return load;
}

std::array<Function, 3> read_components(Section& section, const Dimension& dimension) {
    if (!section.has("value") && !section.has("x") && !section.has("y") && !section.has("z")) {
        section.mistake("",
                        fmt::format("{} needs 'value' or some of 'x', 'y', 'z'", section.title()));
    }
    const auto components = section.components("value", dimension);
    std::array<Function, 3> result;
    for (std::size_t i = 0; i < 3; ++i) {
        result[i] = components[i].value_or(constant(0.0));
    }
    return result;
}

Function read_value(Section& section, const Dimension& dimension) {
    section.require("value", "a number, a text with a unit, or an expression");
    return section.function("value", dimension).value_or(constant(0.0));
}

void read_point_load(Section& section, iga::Problem& problem) {
    auto load = make_load<iga::PointLoad>(section);
    load.at = section.vector("at", dimensions::length);
    load.on = section.text("on").value_or("");
    section.require("force", "a list of components");
    load.force = section.vector("force", dimensions::force).value_or(Vector3::Zero());
    read_time(section, load);
    section.refuse_third("force", load.force[2] != 0.0);
    section.refuse_third("at", load.at && (*load.at)[2] != 0.0);
    if (section.has("at") == section.has("on")) {
        section.mistake("", fmt::format("{} needs either 'at' (a point) or 'on' (a set of corners)",
                                        section.title()));
    }
    problem.point_loads.push_back(std::move(load));
}

void read_resultant(Section& section, iga::Problem& problem) {
    auto load = make_load<iga::Resultant>(section);
    section.require("on", "the name of one boundary set");
    load.on = section.text("on").value_or("");
    load.force = section.vector("force", dimensions::force).value_or(Vector3::Zero());
    load.moment = section.vector("moment", dimensions::moment).value_or(Vector3::Zero());
    if (!section.has("force") && !section.has("moment")) {
        section.mistake("", fmt::format("{} needs 'force' or 'moment'", section.title()));
    }
    if (section.choice("spread", {"traction", "control_points"}).value_or("traction") ==
        "control_points") {
        load.spread = iga::Spread::control_points;
    }
    read_time(section, load);
    problem.resultants.push_back(std::move(load));
}

void read_poisson_loads(Section& top, iga::Problem& problem) {
    for_each_entry(top, "flux", [&](Section& section) {
        auto flux = make_load<iga::Traction>(section);
        flux.components = {read_value(section, dimensions::heat_flux), constant(0.0),
                           constant(0.0)};
        for (const std::string& on : section.sets()) {
            flux.on = on;
            problem.tractions.push_back(flux);
        }
    });
    for_each_entry(top, "source", [&](Section& section) {
        auto source = make_load<iga::BodyForce>(section);
        source.patches = section.patches();
        source.components = {read_value(section, dimensions::heat_source), constant(0.0),
                             constant(0.0)};
        problem.body_forces.push_back(std::move(source));
    });
}

}  // namespace

void read_loads(Section& top, iga::Problem& problem) {
    if (problem.physics == iga::Physics::poisson) {
        read_poisson_loads(top, problem);
        return;
    }
    for_each_entry(top, "pressure", [&](Section& section) {
        auto pressure = make_load<iga::Pressure>(section);
        pressure.value = read_value(section, dimensions::pressure);
        read_time(section, pressure);
        pressure.follows_body = section.flag("follows_body").value_or(true);
        if (section.has("follows_body") && !section.context().is_hyperelastic) {
            section.mistake(
                "follows_body",
                "'follows_body' of [[pressure]] needs hyperelastic materials; in linear "
                "analyses loads act on the undeformed body");
        }
        for (const std::string& on : section.sets()) {
            pressure.on = on;
            problem.pressures.push_back(pressure);
        }
    });
    for_each_entry(top, "traction", [&](Section& section) {
        auto traction = make_load<iga::Traction>(section);
        traction.components = read_components(section, dimensions::pressure);
        read_time(section, traction);
        for (const std::string& on : section.sets()) {
            traction.on = on;
            problem.tractions.push_back(traction);
        }
    });
    for_each_entry(top, "body_force", [&](Section& section) {
        auto force = make_load<iga::BodyForce>(section);
        force.patches = section.patches();
        force.components = read_components(section, dimensions::force_per_volume);
        read_time(section, force);
        problem.body_forces.push_back(std::move(force));
    });
    for_each_entry(top, "point_load", [&](Section& section) { read_point_load(section, problem); });
    for_each_entry(top, "resultant", [&](Section& section) { read_resultant(section, problem); });
    for_each_entry(top, "temperature", [&](Section& section) {
        auto temperature = make_load<iga::Temperature>(section);
        temperature.patches = section.patches();
        section.require("change", "degrees above the strain-free state");
        temperature.change =
            section.function("change", dimensions::temperature).value_or(constant(0.0));
        problem.temperatures.push_back(std::move(temperature));
    });
}

}  // namespace couture::io
