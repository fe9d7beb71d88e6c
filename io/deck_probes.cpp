#include <fmt/format.h>

#include <algorithm>

#include "io/deck_readers.h"
#include "io/did_you_mean.h"
#include "io/quantity.h"

namespace couture::io {

namespace {

void read_place(Section& section, const QuantityInfo& info, Probe& probe) {
    probe.at = section.vector("at", dimensions::length);
    constexpr int max_patches = 1'000'000'000;
    probe.patch = section.integer("patch", 0, max_patches);
    probe.xi = section.numbers("xi", dimensions::none, {2, 3});
    probe.on = section.text("on").value_or("");
    const bool has_point = section.has("at");
    const bool has_parameter = section.has("patch") || section.has("xi");
    using Place = QuantityInfo::Place;
    if (info.place == Place::point) {
        if (has_point == has_parameter || section.has("patch") != section.has("xi") ||
            section.has("on")) {
            section.mistake(
                "quantity",
                fmt::format("'{}' needs a place: either 'at', or 'patch' and 'xi'", info.name));
        }
    } else if (has_point || has_parameter || section.has("on") != (info.place == Place::set)) {
        section.mistake("quantity",
                        info.place == Place::set
                            ? fmt::format("'{}' needs 'on' (a support's set) and no "
                                          "other place",
                                          info.name)
                            : fmt::format("'{}' belongs to the entire body: it takes no "
                                          "place",
                                          info.name));
    }
}

void read_expectation(Section& section, const QuantityInfo& info, Probe& probe) {
    probe.expect = section.number("expect", info.dimension);
    probe.tolerance =
        section.number("tolerance", dimensions::none, not_negative).value_or(probe.tolerance);
    probe.absolute_tolerance =
        section.number("absolute_tolerance", info.dimension, not_negative).value_or(0.0);
    if (!section.has("expect") && (section.has("tolerance") || section.has("absolute_tolerance"))) {
        section.mistake("", fmt::format("{} has a tolerance but no 'expect'", section.title()));
    }
    if (probe.expect == 0.0 && probe.absolute_tolerance == 0.0) {
        section.mistake("expect",
                        "'expect' = 0 needs an 'absolute_tolerance' ('tolerance' is "
                        "relative)");
    }
}

}  // namespace

void read_probes(Section& output, const Deck& deck, std::vector<Probe>& probes) {
    const iga::Problem& problem = deck.problem;
    const bool is_elasticity = problem.physics == iga::Physics::elasticity;
    std::vector<std::string> names;
    for (const QuantityInfo& info : quantities(is_elasticity)) {
        names.push_back(info.name);
    }
    std::vector<std::string> cases = problem.load_cases();
    for (const auto& [name, factors] : problem.combinations) {
        cases.push_back(name);
    }
    for_each_entry(output, "probe", [&](Section& section) {
        Probe probe;
        probe.source = section.place().source;
        probe.name = section.text("name").value_or("");
        section.require("quantity", "what to report, such as 'von_mises'");
        const auto quantity = section.choice("quantity", names);
        const QuantityInfo info = quantity ? *find_quantity(*quantity, is_elasticity)
                                           : QuantityInfo{"", QuantityInfo::Place::point, {}};
        probe.quantity = info.name;
        read_expectation(section, info, probe);
        if (quantity) {
            read_place(section, info, probe);
        } else {
            for (const char* key : {"at", "patch", "xi", "on"}) {
                static_cast<void>(section.find(key));
            }
        }
        probe.t = section.number("t", dimensions::time, positive);
        if (section.has("t") && !deck.is_hyperelastic()) {
            section.mistake("t",
                            "'t' of [[output.probe]] is a time of a hyperelastic run; the "
                            "materials of this deck are linear");
        } else if (probe.t.value_or(0.0) > deck.stepping.end) {
            section.mistake("t", fmt::format("'t' of [[output.probe]] = {:g} is after the end of "
                                             "the run, {:g}",
                                             *probe.t, deck.stepping.end));
        }
        if (cases.size() > 1) {
            probe.load_case = section.choice("case", cases).value_or("");
            if (!section.has("case") && probe.quantity != "volume") {
                section.mistake("", fmt::format("{} needs 'case', one of {}", section.title(),
                                                quoted_list(cases)));
            }
        } else {
            probe.load_case = section.text("case").value_or(cases.empty() ? "" : cases[0]);
            if (!cases.empty() && probe.load_case != cases[0]) {
                section.mistake("case", fmt::format("there is no load case '{}'", probe.load_case));
            }
        }
        probes.push_back(std::move(probe));
    });
}

}  // namespace couture::io
