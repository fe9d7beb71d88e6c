#include <fmt/format.h>

#include <algorithm>

#include "iga/core/log.h"
#include "io/deck_readers.h"
#include "io/did_you_mean.h"

namespace couture::io {

namespace {

/// Notes a mistake unless the numbers of a list increase.
void require_increasing(Section& section, const std::string& key, const std::vector<double>& list) {
    for (std::size_t i = 1; i < list.size(); ++i) {
        if (!(list[i] > list[i - 1])) {
            section.mistake(key, fmt::format("'{}' of {}: {:g} follows {:g}; times must increase",
                                             key, section.title(), list[i], list[i - 1]));
            return;
        }
    }
}

}  // namespace

void read_amplitudes(Section& top) {
    DeckContext& context = top.context();
    for_each_named(top, "amplitude", [&](const std::string& name, Section& section) {
        section.require("t", "a list of increasing times");
        section.require("value", "a list of factors, one for each time");
        iga::Amplitude amplitude{name, section.number_list("t", dimensions::time),
                                 section.number_list("value", dimensions::none)};
        require_increasing(section, "t", amplitude.times);
        if (amplitude.times.empty() || amplitude.values.empty()) {
            amplitude.times = amplitude.values = {0.0};
        } else if (amplitude.times.size() != amplitude.values.size()) {
            section.mistake("value", fmt::format("{}: 't' has {} numbers, 'value' has {}; each "
                                                 "time needs one value",
                                                 section.title(), amplitude.times.size(),
                                                 amplitude.values.size()));
            amplitude.values.resize(amplitude.times.size(), 0.0);
        }
        context.amplitudes.push_back(std::move(amplitude));
    });
    if (!context.amplitudes.empty() && !context.is_hyperelastic) {
        top.mistake("amplitude",
                    "[amplitude.NAME] is a table over time, which linear analyses do not have; "
                    "write a load case for each time");
    }
}

void read_time(Section& section, iga::CaseEntry& entry) {
    DeckContext& context = section.context();
    entry.follows_time = section.names_time();
    const std::optional<std::string> name = section.text("amplitude");
    if (!name) {
        context.has_ramp = context.has_ramp || !entry.follows_time;
        return;
    }
    const auto found = std::find_if(context.amplitudes.begin(), context.amplitudes.end(),
                                    [&](const iga::Amplitude& one) { return one.name == *name; });
    if (found != context.amplitudes.end()) {
        entry.amplitude = *found;
        context.used_amplitudes.insert(*name);
        return;
    }
    std::vector<std::string> names;
    for (const iga::Amplitude& one : context.amplitudes) {
        names.push_back(one.name);
    }
    std::string help = did_you_mean(*name, names);
    if (help.empty()) {
        help = names.empty() ? "; the deck has no [amplitude.NAME]"
                             : fmt::format("; there are {}", quoted_list(names));
    }
    section.mistake("amplitude", fmt::format("unknown amplitude '{}'{}", *name, help));
}

namespace {

constexpr int max_steps = 1'000'000;
constexpr int max_newton_iterations = 1000;

void read_step_sizes(Section& section, iga::SteppingOptions& stepping) {
    const iga::SteppingOptions unit;
    const auto time = [&](const char* key) {
        return section.number(key, dimensions::time, positive);
    };
    stepping.end = time("end").value_or(stepping.end);
    const auto smallest = time("smallest_step");
    const auto first = time("first_step");
    const auto largest = time("largest_step");
    // What is not given gives way to what is.
    const double end = stepping.end;
    stepping.first_step = first.value_or(
        std::max(smallest.value_or(0.0), std::min(unit.first_step * end, largest.value_or(end))));
    stepping.smallest_step =
        smallest.value_or(std::min(unit.smallest_step * end, stepping.first_step));
    stepping.largest_step =
        largest.value_or(std::max(unit.largest_step * end, stepping.first_step));
    const auto order = [&](const char* key, double value, const char* above, double bound) {
        if (value > bound) {
            section.mistake(key,
                            fmt::format("'{}' of [stepping] = {:g} is larger than '{}' = {:g}; "
                                        "smallest_step <= first_step <= largest_step <= end",
                                        key, value, above, bound));
        }
    };
    if (section.has("first_step") || section.has("smallest_step")) {
        order(section.has("smallest_step") ? "smallest_step" : "first_step", stepping.smallest_step,
              "first_step", stepping.first_step);
    }
    order(section.has("first_step") ? "first_step" : "largest_step", stepping.first_step,
          "largest_step", stepping.largest_step);
    order(section.has("largest_step") ? "largest_step" : "first_step", stepping.largest_step, "end",
          end);
}

void read_stepping_section(Section& section, iga::SteppingOptions& stepping) {
    read_step_sizes(section, stepping);
    stepping.max_steps = section.integer("max_steps", 1, max_steps).value_or(0);
    if (section.choice("control", {"load", "arc_length"}).value_or("load") == "arc_length") {
        stepping.control = iga::Control::arc_length;
        if (!section.has("max_steps")) {
            section.mistake("control",
                            "control = 'arc_length' of [stepping] needs 'max_steps': such a run "
                            "may go back in time and never reach its end");
        }
    }
    stepping.newton.tolerance =
        section.number("tolerance", dimensions::none, {.low = 0.0, .high = 1.0, .is_open = true})
            .value_or(stepping.newton.tolerance);
    stepping.newton.max_iterations = section.integer("max_iterations", 1, max_newton_iterations)
                                         .value_or(stepping.newton.max_iterations);
}

void read_remeshing(Section& section, Deck& deck) {
    RemeshingOptions options;
    options.source = section.place().source;
    options.times = section.number_list("at", dimensions::time, positive);
    require_increasing(section, "at", options.times);
    if (!options.times.empty() && options.times.back() >= deck.stepping.end) {
        section.mistake("at", fmt::format("'at' of [remeshing] holds {:g}, not before the end of "
                                          "the run, {:g}",
                                          options.times.back(), deck.stepping.end));
    }
    if (section.has("at") && deck.stepping.control == iga::Control::arc_length) {
        section.mistake("at",
                        "'at' of [remeshing]: steps of control = 'arc_length' end at no given "
                        "time; take another trigger, or control = 'load'");
    }
    options.shape_ratio =
        section.number("shape_ratio", dimensions::none, {.low = 1.74, .is_open = true});
    options.scaled_jacobian = section.number("scaled_jacobian", dimensions::none,
                                             {.low = 0.0, .high = 1.0, .is_open = true});
    options.angle_deviation = section.number("angle_deviation", dimensions::none, positive);
    options.on_failure = section.flag("on_failure").value_or(false);
    if (section.choice("mesher", {"slide", "surface"}).value_or("slide") == "surface") {
        options.mesher = Mesher::surface;
    }
    if (section.choice("transfer", {"displacement", "gradient"}).value_or("displacement") ==
        "gradient") {
        options.transfer = iga::Transfer::gradient;
    }
    options.max_remeshings =
        section.integer("max_remeshings", 1, max_steps).value_or(options.max_remeshings);
    if (!section.has("at") && !section.has("shape_ratio") && !section.has("scaled_jacobian") &&
        !section.has("angle_deviation") && !options.on_failure) {
        section.mistake("",
                        "[remeshing] says never; give 'at', 'shape_ratio', 'scaled_jacobian', "
                        "'angle_deviation' or on_failure = true");
    }
    if (deck.problem.kinematics != iga::Kinematics::solid) {
        section.mistake("", "[remeshing] is for volumes; plane bodies can't be meshed again");
    }
    deck.remeshing = std::move(options);
}

}  // namespace

void read_stepping(Section& top, Deck& deck) {
    const DeckContext& context = top.context();
    if (!context.is_hyperelastic) {
        for (const char* name : {"stepping", "remeshing"}) {
            if (top.has(name)) {
                top.mistake(name, fmt::format("[{}] belongs to hyperelastic materials; those of "
                                              "this deck are linear",
                                              name));
            }
        }
        const TomlNode* discretization = top.find("discretization");
        if (discretization != nullptr && discretization->find("volumetric") != nullptr) {
            top.context().mistakes.add(
                discretization->find("volumetric")->place,
                "'volumetric' of [discretization] belongs to hyperelastic materials; those of this "
                "deck are linear");
        }
        return;
    }
    for_section(top, "stepping",
                [&](Section& section) { read_stepping_section(section, deck.stepping); });
    for_section(top, "remeshing", [&](Section& section) { read_remeshing(section, deck); });
    for (const iga::Amplitude& amplitude : context.amplitudes) {
        if (context.used_amplitudes.count(amplitude.name) == 0) {
            log::warn(fmt::format("[amplitude.{}] is used by no load", amplitude.name));
        }
    }
}

std::vector<double> stops_of(const Deck& deck, const DeckContext& context) {
    std::vector<double> stops;
    for (const iga::Amplitude& amplitude : context.amplitudes) {
        if (context.used_amplitudes.count(amplitude.name) != 0) {
            stops.insert(stops.end(), amplitude.times.begin(), amplitude.times.end());
        }
    }
    for (const Probe& probe : deck.probes) {
        if (probe.t) {
            stops.push_back(*probe.t);
        }
    }
    if (deck.remeshing) {
        stops.insert(stops.end(), deck.remeshing->times.begin(), deck.remeshing->times.end());
    }
    std::erase_if(stops, [&](double t) { return !(t > 0.0 && t < deck.stepping.end); });
    std::sort(stops.begin(), stops.end());
    stops.erase(std::unique(stops.begin(), stops.end()), stops.end());
    return stops;
}

namespace {

/// A value in one spelling.
void append(std::string& text, const TomlNode& node) {
    using Kind = TomlNode::Kind;
    switch (node.kind) {
        case Kind::boolean:
            text += node.boolean ? "true" : "false";
            break;
        case Kind::integer:
        case Kind::number:
            text += fmt::format("{}", node.number);
            break;
        case Kind::text:
        case Kind::date:
            text += fmt::format("\"{}\"", node.text);
            break;
        case Kind::array:
            text += '[';
            for (const TomlNode& item : node.items) {
                append(text, item);
                text += ',';
            }
            text += ']';
            break;
        case Kind::table:
            text += '{';
            for (const auto& [key, value] : node.entries) {
                text += key + '=';
                append(text, value);
                text += ',';
            }
            text += '}';
            break;
    }
}

}  // namespace

std::string model_text_of(const TomlNode& document, const Deck& deck, const DeckContext& context) {
    static const std::vector<std::string> others = {"title", "stepping", "solver", "remeshing",
                                                    "output", "rom"};
    std::string text;
    for (const auto& [key, value] : document.entries) {
        if (std::find(others.begin(), others.end(), key) == others.end()) {
            text += key + '=';
            append(text, value);
            text += '\n';
        }
    }
    if (context.is_hyperelastic && context.has_ramp) {
        text += fmt::format("end={}\n", deck.stepping.end);
    }
    return text;
}

}  // namespace couture::io
